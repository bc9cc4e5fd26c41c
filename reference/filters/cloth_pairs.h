// Which features of the cloth may be near each other: vertices and triangles, edges and edges.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "reference/mesh/box_tree.h"
#include "reference/mesh/triangle_mesh.h"
#include "reference/types.h"

namespace foldproof {

enum class PairKind { vertex_triangle, edge_edge };

/// Two features without a particle in common.
struct FeaturePair {
  PairKind kind;
  std::array<int, 4>
      particles;  // the vertex and the triangle's corners; or the first edge's ends and the second's
};

/// Boxes over the cloth's triangles, in an order that its rest shape fixes; fitted anew to each motion.
struct ClothTree {
  std::vector<Triangle> triangles;  // M
  std::vector<Edge> edges;
  std::vector<std::array<bool, 3>>
      has_vertex;  // M: whether the triangle speaks for its corner k; one triangle does
  std::vector<std::array<int, 3>>
      has_edge;  // M: the edge from corner k to the next if it speaks for it, else -1
  BoxTree tree;  // over the triangles
};

ClothTree make_cloth_tree(const TriangleMesh& mesh);

}  // namespace foldproof
