// Inside or outside by counting: a second opinion on signs, and where it differs from the first.
#pragma once

#include <cstdint>
#include <vector>

#include "reference/level_set/grid.h"
#include "reference/mesh/triangle_mesh.h"

namespace foldproof {

/// For each node the number of axes (0 to 3) along which a ray from it crosses the surface an
/// odd number of times: 3 inside and 0 outside of a closed surface. A hole, or a triangle given
/// twice, turns one axis along the streaks of nodes that it hides; whoever needs one answer
/// takes the majority.
///
/// A ray that runs through an edge or a vertex crosses exactly one of the triangles that meet
/// there: a triangle counts by the even-odd rule over its edges, each half open and judged the same
/// from both of its triangles. The lattice must reach beyond the surface on its lower sides.
std::vector<std::uint8_t> ray_parity(const PerParticle3& x, const std::vector<Triangle>& triangles,
                                     const Lattice& lattice);

/// Nodes whose sign the majority of the rays denies, and those where the rays do not agree
/// among themselves.
struct Disagreement {
  std::vector<long> with_sign, among_rays;  // indices into the lattice, rising
};

/// Nodes closer to the surface than `skin` [m] are left out: there either answer is rounding.
Disagreement disagreement(const Grid& grid, const std::vector<std::uint8_t>& parity, double skin);

}  // namespace foldproof
