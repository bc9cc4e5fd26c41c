// converge.h5: what `foldproof converge` found, for reports.
#pragma once

#include <string>
#include <vector>

#include "verification/verdict.h"

namespace foldproof {

/// Writes the studies as a run that has nothing else, as HDF5 (verification/FORMAT.md).
/// command: what was typed. Throws std::runtime_error naming the file.
void write_studies(const std::string& path, std::vector<StudyRecord> studies,
                   const std::string& command);

}  // namespace foldproof
