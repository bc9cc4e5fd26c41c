// A run as HDF5: its findings, studies, cases and seeded faults.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "verification/verdict.h"
#include "verification/claims/claims.h"
#include "verification/faults/faults.h"
#include "verification/files/provenance_file.h"

namespace foldproof {

struct CaseRecord {
  std::string name, file, title, about;  // file: relative to run.h5
  double seconds = 0;
  std::string stopped;  // "" or the reason
};

/// Where and when jobs of a run were run.
struct RunOrigin {
  std::string commit, tree, date;  // as in Provenance
  size_t jobs = 0;

  /// "12 jobs on 0123456789 (clean), begun 2026-01-31T12:00:00Z"
  std::string text() const;
};

/// What a solver on trial declares, as far as bounds and what is asked of it depend on it.
struct Declared {
  int level = 0;
  std::string precision;  // "f4" or "f8"
  int order = 0;          // claimed; 0: none
  double solve_tolerance = 0;
  std::vector<std::string> capabilities;
};

struct RunRecord {
  Provenance provenance;
  std::string tier, subject, subject_version;
  unsigned seed = 0;  // by which the seeds of all samples were shifted (seeds.h)
  double seconds = 0;
  std::vector<Record> records;
  std::vector<StudyRecord> studies;
  std::vector<CaseRecord> cases;
  std::vector<Fault> faults;
  std::vector<ClaimRecord> claims;
  // of a run that was interrupted and went on: where its parts come from, the oldest first
  std::vector<RunOrigin> origins;
  std::optional<Declared> declared;  // of a solver on trial that started
};

/// The texts of all origins, or "" for a run that was never interrupted.
std::string origins_text(const RunRecord& run);

/// Writes the whole run to `path`, under a temporary name first and renamed when complete. Throws
/// std::runtime_error naming the file.
void write_run(const std::string& path, const RunRecord& run);

}  // namespace foldproof
