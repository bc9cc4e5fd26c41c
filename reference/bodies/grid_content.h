// What a grid is made of and made into, as keys: equal keys, equal content. For caches.
#pragma once

#include <string>

#include "reference/bodies/repair.h"

namespace foldproof {

/// Of everything that make_level_set computes from, bit for bit, and the version of its method.
std::string input_key(const TriangleSoup& soup, const GridMethod& method, Repair repair);

/// Of the grid itself.
std::string content_key(const Grid& grid);

/// Throws InputError saying what is wrong with a grid that no build made. A sound grid can be
/// asked anywhere.
void require_valid_content(const Grid& grid);

}  // namespace foldproof
