// Signed distance on a regular grid of nodes, trilinear between them.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "reference/level_set/signed_distance.h"
#include "reference/mesh/box_tree.h"

namespace foldproof {

using Node = std::array<int, 3>;  // i, j, k along x, y, z

/// Nodes at origin + spacing (i, j, k), 0 <= i < nodes[0] and so on.
struct Lattice {
  Vector3 origin;  // m
  double spacing;  // h [m]
  Node nodes;      // along x, y, z; at least 2 each

  long size() const { return long(nodes[0]) * nodes[1] * nodes[2]; }
  long index(const Node& n) const { return (long(n[2]) * nodes[1] + n[1]) * nodes[0] + n[0]; }
  Node node(long index) const;
  Vector3 position(const Node& n) const { return origin + spacing * Vector3(n[0], n[1], n[2]); }
  Bounds bounds() const;
  /// Index offset from a node to the next along each axis.
  std::array<long, 3> strides() const { return {1, nodes[0], long(nodes[0]) * nodes[1]}; }
};

/// `cells` along the longest side of the bounds, and `margin` cells more on every side; the other
/// sides are rounded up to whole cells, with the bounds centred. Throws InputError for bounds
/// without extent, fewer than 4 cells, margin < 1, or more than 2^30 nodes.
Lattice lattice_about(const Bounds& bounds, int cells, int margin);

/// Signed distance at the nodes of a lattice.
///
/// Accuracy between nodes, where phi is smooth and nodal values are exact: value h^2 (second
/// differences of phi)/8 at most, cell gradient O(h), nodal gradient O(h^2). At a kink the nodal
/// gradient is blended over two cells.
struct Grid {
  Lattice lattice;
  std::vector<double> phi;  // at the nodes, in the order of Lattice::index [m]

  /// Inside the lattice: the trilinear value, and the trilinear blend of the nodes' central
  /// differences (one-sided at the lattice's border), made a unit vector. Outside: the distance to
  /// a surface point found by a few search steps from the border. It is continuous at the border,
  /// and never less than the true distance except for the grid's own error. NaN for p that is not
  /// finite.
  Distance at(const Vector3& p) const;
  /// The trilinear value and the gradient of the trilinear interpolant, which jumps from cell to
  /// cell and is not made a unit vector. p must be in the lattice's bounds.
  Distance in_cell(const Vector3& p) const;
};

/// A solid represented by a grid; copies share it.
struct GridSolid {
  std::shared_ptr<const Grid> grid;
  Distance at(const Vector3& p) const { return grid->at(p); }
};

}  // namespace foldproof
