// Verdicts for other programs: JSON and JUnit XML.
#pragma once

#include <string>

#include "verification/results_file.h"

namespace foldproof {

/// The findings as JSON text: {"schema": 1, "program": {...}, "findings": [...]}. NaN becomes null.
std::string verdicts_json(const RunRecord& run);

/// Writes verdicts.json and junit.xml into the folder, each renamed when whole.
void write_verdicts(const std::string& folder, const RunRecord& run);

}  // namespace foldproof
