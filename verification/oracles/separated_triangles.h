// Tests whether a plane separates two triangles, by a method independent of exact_geometry.h, to
// verify that file.
#pragma once

#include "verification/oracles/exact_geometry.h"

namespace foldproof::oracles {

/// Normal of the triangle, twice its area long.
Vector3 normal_of(const Corners3& t);

/// Two triangles with an area are apart if and only if one of seventeen directions separates them:
/// normals, edges within the planes turned by a right angle, and products of edges. Exact for
/// small whole numbers.
bool are_separated(const Corners3& s, const Corners3& t);

}  // namespace foldproof::oracles
