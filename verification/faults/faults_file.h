// The list of seeded faults, verification/faults/faults.toml.
#pragma once

#include <string>
#include <vector>

#include "verification/files/results_file.h"

namespace foldproof {

/// Throws InputError "file:line: ..." for a row that lacks a key or has an unknown one.
std::vector<Fault> read_faults(const std::string& path);

/// Writes into each record the names of the faults that it catches.
void name_faults(const std::vector<Fault>& faults, std::vector<Record>& records);

}  // namespace foldproof
