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
/// [m]. Without a particle in common they meet if the closed sets have a point in common: touching
/// is meeting. With one in common they always have that; they are counted if the edge's other end
/// lies in the triangle, or the edge meets the triangle's opposite side: neighbours folded flat
/// onto each other are, flat ones side by side are not. An edge and the triangles that it belongs
/// to are no pair. Throws std::invalid_argument if some position is not finite.
std::vector<EdgeInTriangle> exact_crossings(const PerParticle3& x,
                                            const std::vector<std::array<int, 3>>& triangles);

}  // namespace foldproof::oracles
