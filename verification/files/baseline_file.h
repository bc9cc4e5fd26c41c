// Kept verdicts of a run, and what a newer run has worse.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "verification/files/results_file.h"

namespace foldproof {

/// A finding of a kept verdicts.json.
struct KeptVerdict {
  std::string name, outcome;
  double measured = 0, bound = 0;  // NaN: none
};

/// A kept verdicts.json.
struct Baseline {
  std::vector<KeptVerdict> verdicts;  // of all findings but claims
  std::optional<Declared> declared;   // of the solver that was judged; none in older files
};

/// Throws InputError naming the file if it is no verdicts.json, or if none of its findings ran.
Baseline read_baseline(const std::string& path);

/// A line for each finding that differs; the others are as they were.
struct BaselineChanges {
  std::vector<std::string> worse, better, other;
  std::set<std::string> worse_names;  // of the findings that are worse
  std::vector<std::string> looser;    // of the declaration; they are worse, too
};

/// Worse is
///   - what fails or is inconclusive now, and did not or was not,
///   - what held, and is not applicable now,
///   - what failed, and fails by more than twice as much, or without a number,
///   - what did not run, and held, failed or was inconclusive before,
///   - a declaration that widens bounds: f4 after f8, a larger tolerance, a lower order.
/// A finding that only one of the two has is neither worse nor better.
BaselineChanges changes_since(const Baseline& kept, const RunRecord& run);

}  // namespace foldproof
