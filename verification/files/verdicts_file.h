// Verdicts for other programs: JSON and JUnit XML.
#pragma once

#include <string>

#include "verification/files/results_file.h"

namespace foldproof {

/// The findings as JSON text: {"schema": 1, "program": {...}, "findings": [...]}. NaN becomes null.
std::string verdicts_json(const RunRecord& run);

/// The text escaped for XML, also in attributes: characters that XML does not allow (control
/// characters, invalid UTF-8) become a blank or U+FFFD.
std::string xml_text(const std::string& text);

/// Writes verdicts.json and junit.xml into the folder, each renamed when complete.
void write_verdicts(const std::string& folder, const RunRecord& run);

}  // namespace foldproof
