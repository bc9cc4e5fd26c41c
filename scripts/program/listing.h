// The findings of a run as text, a line for each.
#pragma once

#include <string>

#include "verification/files/results_file.h"

namespace foldproof {

/// Outcome, name, measured, bound, unit of each finding; below one that fails, its claim, the
/// reason of the bound, and its note. Findings in a row that did not run for one reason share a
/// line, and those that fail by the same failure of a solver share what is said of the first.
std::string listing(const RunRecord& run);

}  // namespace foldproof
