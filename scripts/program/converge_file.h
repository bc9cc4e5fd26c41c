// converge.h5: what `foldproof converge` found, for reports.
#pragma once

#include <string>
#include <vector>

#include "convergence/any_case/converge.h"

namespace foldproof {

/// Writes the answers as studies of a run that has nothing else, as HDF5 (verification/FORMAT.md).
/// command: what was typed. Throws std::runtime_error naming the file.
void write_answers(const std::string& path, const std::vector<LadderAnswer>& answers,
                   const std::string& command);

}  // namespace foldproof
