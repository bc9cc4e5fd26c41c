// Studies in an HDF5 file: their figures, maps and tables.
#pragma once

#include <vector>

#include "verification/verdict.h"

namespace foldproof {

class Hdf5;

/// `/studies/<name>`. Throws std::logic_error for a map that has not one value for
/// each of its points.
void write_studies(const Hdf5& file, const std::vector<StudyRecord>& studies);

}  // namespace foldproof
