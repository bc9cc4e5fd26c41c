// Verdicts for other programs: JSON and JUnit XML.
#pragma once

#include <string>

#include "verification/files/results_file.h"

namespace foldproof {

/// The findings as JSON text: {"schema": 1, "program": {...}, "findings": [...]}. NaN becomes null.
std::string verdicts_json(const RunRecord& run);

/// The text as it may stand in XML, in an attribute too: what no XML may hold (control characters,
/// bytes that are no UTF-8) becomes a blank or U+FFFD.
std::string xml_text(const std::string& text);

/// Writes verdicts.json and junit.xml into the folder, each renamed when whole.
void write_verdicts(const std::string& folder, const RunRecord& run);

}  // namespace foldproof
