// Kept verdicts of a run, and what a newer run has worse.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "verification/verdict.h"

namespace foldproof {

/// A finding of a kept verdicts.json.
struct KeptVerdict {
  std::string name, outcome;
  double measured = 0, bound = 0;  // NaN: none
};

/// The findings of a verdicts.json but claims. Throws InputError naming the file if it is none, or
/// if none of them ran.
std::vector<KeptVerdict> read_baseline(const std::string& path);

/// A line for each finding that differs; the others are as they were.
struct BaselineChanges {
  std::vector<std::string> worse, better, other;
  std::set<std::string> worse_names;  // of the findings that are worse
};

/// Worse is
///   - what fails or is inconclusive now, and did not or was not,
///   - what held, and is not applicable now,
///   - what failed, and fails by more than twice as much, or without a number,
///   - what did not run, and did before.
/// A finding that only one of the two has is neither worse nor better.
BaselineChanges changes_since(const std::vector<KeptVerdict>& kept,
                              const std::vector<Record>& records);

}  // namespace foldproof
