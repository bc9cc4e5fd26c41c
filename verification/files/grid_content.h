// Cache keys of a grid: of its input, and of the grid itself.
#pragma once

#include <string>

#include "reference/bodies/repair.h"

namespace foldproof {

/// Key of all input of make_level_set, bit for bit, and of the version of its method.
std::string input_key(const TriangleSoup& soup, const GridMethod& method, Repair repair);

/// Key of the grid itself.
std::string content_key(const Grid& grid);

/// Validates a grid that was read rather than built; throws InputError naming the defect. A valid
/// grid can be queried anywhere.
void require_valid_content(const Grid& grid);

}  // namespace foldproof
