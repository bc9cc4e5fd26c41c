// A pair of features, a vertex and a triangle or two edges: their distance, and where
// it is attained.
#pragma once

#include <array>
#include <optional>

#include "reference/types.h"

namespace foldproof {

enum class PairKind { vertex_triangle, edge_edge };

/// Two features without a particle in common.
struct FeaturePair {
  PairKind kind;
  // the vertex and the triangle's corners; or the first edge's ends and the second's
  std::array<int, 4> particles;
};

// columns: four points, in the order of FeaturePair [m]
using Corners4 = Eigen::Matrix<double, 3, 4>;

/// Columns of the pair's particles.
Corners4 corners_of(const FeaturePair& pair, const PerParticle3& of);

/// Where two features are nearest to each other:  sum_i weights_i x_i = distance normal.
/// The weights are (1, -w1, -w2, -w3) for a vertex and the triangle's point w1 x1 + w2 x2 + w3 x3,
/// and (1 - a, a, -(1 - b), -b) for the points x0 + a (x1 - x0) and x2 + b (x3 - x2) of two edges.
struct Nearness {
  double distance;          // m
  Vector3 normal;           // from the second feature to the first [1]; zero where they touch
  Eigen::Vector4d weights;  // 1
};

/// Degenerate triangles and degenerate or parallel edges are handled through their sides and ends.
Nearness nearness(PairKind kind, const Corners4& x);

/// Of two edges that are nearest between their ends: x0 x1 and x2 x3, not parallel.
std::optional<Nearness> nearness_inside_edges(const Corners4& x);

}  // namespace foldproof
