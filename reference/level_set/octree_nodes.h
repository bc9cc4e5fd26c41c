// The nodes of an octree: their positions, which of them hang, and the interpolant of a cell.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "reference/level_set/octree.h"

namespace foldproof {

/// A cell's level and its place among the 2^level cells along each axis.
struct OctreePlace {
  int level;
  std::array<int, 3> cell;
};

/// The place of every branch, in order.
std::vector<OctreePlace> branch_places(const Octree& tree);

/// The node with these indices among the 2^level + 1 along each axis [m]: the same bits
/// on every level.
Vector3 lattice_position(const OctreeSettings& settings, int level,
                         const std::array<int, 3>& index);

/// Node n (0 .. 26) of the branch at this place [m].
Vector3 node_position(const OctreeSettings& settings, const OctreePlace& place, int n);

/// The place of child c.
OctreePlace child_place(const OctreePlace& place, int c);

/// The index of a branch's child c among all branches; c must be a branch.
inline int inner_child(const OctreeBranch& branch, int c) {
  return branch.children + std::popcount(branch.inner & ((1u << c) - 1));
}

/// The first corner of child c among the nodes of its branch; the others follow at `corner_steps`.
inline int first_corner(int c) { return (c & 1) + 3 * ((c >> 1) & 1) + 9 * (c >> 2); }
inline constexpr std::array<int, 8> corner_steps = {0, 1, 3, 4, 9, 10, 12, 13};

/// Bit n: node n hangs, because a leaf as wide as the branch has it in the middle of an
/// edge or a face.
std::uint32_t hanging_nodes(const Octree& tree, const OctreePlace& place);

/// The mean of the 2, 4 or 8 corners of the branch that node n is in the middle
/// of; itself for a corner.
template <class T>
T corner_mean(const BranchNodes<T>& nodes, int n) {
  const int x = n % 3, y = n / 3 % 3, z = n / 9;
  const auto along_x = [&](int row) {
    return x == 1 ? T(0.5 * (nodes[row] + nodes[row + 2])) : nodes[row + x];
  };
  const auto along_y = [&](int sheet) {
    return y == 1 ? T(0.5 * (along_x(sheet) + along_x(sheet + 6))) : along_x(sheet + 3 * y);
  };
  return z == 1 ? T(0.5 * (along_y(0) + along_y(18))) : along_y(9 * z);
}

/// Sets each hanging node to the interpolant of the coarse neighbour: the mean of the
/// surrounding corners.
template <class T>
void constrain(std::uint32_t hanging, BranchNodes<T>& nodes) {
  for (int n = 0; n < 27; ++n)
    if (hanging >> n & 1) nodes[n] = corner_mean(nodes, n);
}

/// A value and its derivatives along the axes of the cell, per width of the cell.
struct Trilinear {
  double value;
  Vector3 slope;
};

/// Child c's interpolant at the local point t (0 to 1 along each axis).
inline Trilinear trilinear(const BranchNodes<double>& nodes, int c, const Vector3& t) {
  const double* v = nodes.data() + first_corner(c);
  const double x00 = v[1] - v[0], x10 = v[4] - v[3], x01 = v[10] - v[9], x11 = v[13] - v[12];
  const double v00 = v[0] + t.x() * x00, v10 = v[3] + t.x() * x10;
  const double v01 = v[9] + t.x() * x01, v11 = v[12] + t.x() * x11;
  const double y0 = v10 - v00, y1 = v11 - v01;
  const double v0 = v00 + t.y() * y0, v1 = v01 + t.y() * y1;
  const double x0 = x00 + t.y() * (x10 - x00), x1 = x01 + t.y() * (x11 - x01);
  return {v0 + t.z() * (v1 - v0), {x0 + t.z() * (x1 - x0), y0 + t.z() * (y1 - y0), v1 - v0}};
}

}  // namespace foldproof
