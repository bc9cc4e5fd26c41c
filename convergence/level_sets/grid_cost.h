// What a grid about a mesh costs: nodes, memory, seconds, error.
#pragma once

#include <vector>

#include "verification/verdict.h"

namespace foldproof {

/// Adds the table `cost` and the figure `error-against-memory` of grids about a statue. cells: along its
/// longest side.
void add_grid_costs(const std::vector<int>& cells, StudyResult& result);

}  // namespace foldproof
