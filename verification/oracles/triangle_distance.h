// Distance from a point to triangles by definition, without a tree or regions.
#pragma once

#include <array>
#include <vector>

#include "reference/types.h"
#include "verification/oracles/estimate.h"

namespace foldproof::oracles {

/// The least distance from p to the triangles over the positions x (3 x N [m]) in extended
/// precision [m]: to the foot on the plane if that lies in the triangle, and to the three edges.
/// The uncertainty is its own rounding.
Estimate distance_to_triangles(const PerParticle3& x,
                               const std::vector<std::array<int, 3>>& triangles, const Vector3& p);

}  // namespace foldproof::oracles
