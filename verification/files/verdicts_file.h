// Verdicts for other programs: JSON and JUnit XML.
#pragma once

#include <string>

#include "verification/files/baseline_file.h"
#include "verification/files/results_file.h"

namespace foldproof {

/// The findings as JSON text: {"schema": 1, "program": {...}, "findings": [...]}. NaN becomes null.
std::string verdicts_json(const RunRecord& run);

/// The text escaped for XML, also in attributes: characters that XML does not allow (control
/// characters, invalid UTF-8) become a blank or U+FFFD.
std::string xml_text(const std::string& text);

/// Writes verdicts.json and junit.xml into the folder, each renamed when complete.
void write_verdicts(const std::string& folder, const RunRecord& run);

/// The same, but in junit.xml the failures are what got worse than a kept baseline; what fails and
/// did not get worse is skipped, with its number. So a dashboard agrees with the exit code.
void write_verdicts_since(const std::string& folder, const RunRecord& run,
                          const BaselineChanges& changes);

}  // namespace foldproof
