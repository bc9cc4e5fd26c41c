// The seeded faults: verification/faults/ROOM.toml, one file for each room of the code
// that they edit.
#pragma once

#include <string>
#include <vector>

#include "verification/verdict.h"

namespace foldproof {

/// A seeded fault: a textual edit of one file, and the findings or tests that must catch it.
struct Fault {
  std::string name, file, find, replace, law;
  std::vector<std::string> caught_by;        // findings
  std::vector<std::string> caught_by_tests;  // test cases
  std::string outcome;                       // "caught", "SURVIVED", ..., or "not run"
  bool is_of_full_tier = false;              // only that tier makes its findings
};

/// The room of a source file, which names the file of its faults: the folder below reference/ or
/// verification/, or the file's base name if it lies directly there; "convergence";
/// "program" for scripts/program/. Empty for any other file.
std::string room_of(const std::string& file);

/// The faults of every *.toml in the folder, in the order of file names; a row without a file has
/// that of the row above. Throws InputError "file:line: ..." for a row that lacks a key, has an
/// unknown one, stands in the file of another room, or repeats the name of an earlier row;
/// "folder: ..." for a folder without such files.
std::vector<Fault> read_faults(const std::string& folder);

/// Writes into each record the names of the faults that it catches.
void name_faults(const std::vector<Fault>& faults, std::vector<Record>& records);

}  // namespace foldproof
