// Inside or outside by counting ray crossings: a second opinion on the sign of the distance.
#pragma once

#include <cstdint>
#include <vector>

#include "reference/level_set/grid.h"
#include "reference/mesh/triangle_mesh.h"

namespace foldproof {

/// For each node the number of axes (0 to 3) along which a ray from it crosses the surface an odd
/// number of times: 3 inside and 0 outside of a closed surface. A hole or a duplicate triangle
/// flips one axis for the rows of nodes behind it; take the majority for a single answer.
///
/// A ray through an edge or a vertex crosses exactly one of the triangles that meet there: edges
/// are half open under the even-odd rule, and both neighbours evaluate a shared edge identically.
/// The lattice must extend beyond the surface on its lower sides.
std::vector<std::uint8_t> ray_parity(const PerParticle3& x, const std::vector<Triangle>& triangles,
                                     const Lattice& lattice);

/// Nodes whose sign contradicts the majority of the rays, and nodes where the rays disagree
/// among themselves.
struct Disagreement {
  std::vector<long> with_sign, among_rays;  // indices into the lattice, rising
};

/// Nodes closer to the surface than `skin` [m] are skipped: there the sign is rounding error.
Disagreement disagreement(const Grid& grid, const std::vector<std::uint8_t>& parity, double skin);

}  // namespace foldproof
