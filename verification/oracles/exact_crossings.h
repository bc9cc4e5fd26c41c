// Where a cloth crosses itself, decided without rounding.
#pragma once

#include <array>
#include <compare>
#include <vector>

#include "reference/types.h"

namespace foldproof::oracles {

struct EdgeInTriangle {
  std::array<int, 2> edge;  // particles, ascending
  int triangle;

  friend auto operator<=>(const EdgeInTriangle&, const EdgeInTriangle&) = default;
};

/// All pairs of an edge and a triangle of the mesh that meet, by edge, then by triangle. x: 3 x N
/// [m]. Without a common particle they meet if the closed sets have a common point, so touching
/// counts. With one common particle they count if the edge's other end lies in the triangle, or the
/// edge meets the triangle's opposite side: this includes neighbours folded flat onto each other,
/// but not flat neighbours side by side. An edge and its own triangles are not a pair. Throws
/// std::invalid_argument if some position is not finite.
std::vector<EdgeInTriangle> exact_crossings(const PerParticle3& x,
                                            const std::vector<std::array<int, 3>>& triangles);

}  // namespace foldproof::oracles
