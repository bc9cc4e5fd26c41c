
#include "reference/level_set/octree_nodes.h"

namespace foldproof {

namespace {

using Cell = std::array<int, 3>;

/// Is the cell of this level a leaf, or inside one? False outside the cube.
bool is_leaf(const Octree& tree, int level, const Cell& cell) {
  for (int axis : cell)
    if (axis < 0 || axis >= 1 << level) return false;
  int b = 0;
  for (int shift = level - 1; shift >= 0; --shift) {
    const int c =
        (cell[0] >> shift & 1) | (cell[1] >> shift & 1) << 1 | (cell[2] >> shift & 1) << 2;
    const OctreeBranch& branch = tree.branches[b];
    if (!(branch.inner >> c & 1)) return true;
    b = inner_child(branch, c);
  }
  return false;
}

/// Direction d = 0 .. 26 is (d % 3 - 1, d / 3 % 3 - 1, d / 9 - 1), so that node n lies
/// towards neighbour n.
Cell neighbour(const Cell& cell, int d) {
  return {cell[0] + d % 3 - 1, cell[1] + d / 3 % 3 - 1, cell[2] + d / 9 - 1};
}

/// Bit d: node n, in the middle of an edge or a face, lies on the neighbour in direction d. These
/// are n's own direction and, for an edge, the directions of its two faces. 0 for corners and the
/// centre.
std::uint32_t neighbours_at(int n) {
  const std::array<int, 3> along = {n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1};
  constexpr std::array<int, 3> step = {1, 3, 9};
  const int outward = std::abs(along[0]) + std::abs(along[1]) + std::abs(along[2]);
  if (outward == 0 || outward == 3) return 0;
  std::uint32_t found = 1u << n;
  if (outward == 2)
    for (int axis = 0; axis < 3; ++axis)
      if (along[axis] != 0) found |= 1u << (n - along[axis] * step[axis]);
  return found;
}

}  // namespace

std::uint32_t hanging_nodes(const Octree& tree, const OctreePlace& place) {
  std::uint32_t leaves = 0, hanging = 0;
  for (int d = 0; d < 27; ++d)
    if (d != 13 && is_leaf(tree, place.level, neighbour(place.cell, d))) leaves |= 1u << d;
  for (int n = 0; n < 27; ++n)
    if (leaves & neighbours_at(n)) hanging |= 1u << n;
  return hanging;
}

}  // namespace foldproof
