// A binary tree of axis-aligned boxes over the triangles of a mesh, for searches that look
// at few of them.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "reference/mesh/triangle_mesh.h"

namespace foldproof {

using Bounds = Eigen::AlignedBox3d;  // m

/// A node holds the items order[first] .. order[first + count - 1]. Its left child is the next node
/// of the list, its right child nodes[right]; a leaf has right = -1.
struct BoxNode {
  Bounds bounds;
  int first, count;
  int right;
};

struct BoxTree {
  std::vector<BoxNode> nodes;  // depth first; the root is nodes[0]
  std::vector<int> order;      // M: the items; those of a node are contiguous
};

/// A tree over M boxes (at least one), each node split at the median of the centres along the
/// longest side of their bounds; leaves hold at most `leaf` items. The same boxes give the same
/// tree.
BoxTree make_box_tree(const std::vector<Bounds>& boxes, int leaf);

/// The bounds of each triangle at the positions x (3 x N [m]).
std::vector<Bounds> triangle_bounds(const PerParticle3& x, const std::vector<Triangle>& triangles);

/// The bounds of all positions x (3 x N [m], N at least 1).
Bounds bounds_of(const PerParticle3& x);

}  // namespace foldproof
