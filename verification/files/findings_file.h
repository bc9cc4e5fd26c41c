// Findings in an HDF5 file.
#pragma once

#include <vector>

#include "verification/verdict.h"

namespace foldproof {

class Hdf5;

/// One dataset per column, in the order of their attribute `order`, each with its `unit`.
void write_columns(const Hdf5& parent, const std::vector<Column>& columns);

/// `/findings/<name>`: the verdict as attributes, the evidence as columns.
void write_findings(const Hdf5& file, const std::vector<Record>& records);

}  // namespace foldproof
