#include "reference/mesh/box_tree.h"

#include <algorithm>
#include <numeric>

namespace foldproof {

namespace {

struct Builder {
  const std::vector<Bounds>& boxes;
  const std::vector<Vector3>& centres;
  int leaf;
  BoxTree tree;

  Bounds bounds(int first, int count) const;
  int longest_side(int first, int count) const;
  int add(int first, int count);
};

Bounds Builder::bounds(int first, int count) const {
  Bounds all;
  for (int i = first; i < first + count; ++i) all.extend(boxes[tree.order[i]]);
  return all;
}

/// The axis along which the centres spread farthest.
int Builder::longest_side(int first, int count) const {
  Bounds spread;
  for (int i = first; i < first + count; ++i) spread.extend(centres[tree.order[i]]);
  Eigen::Index axis;
  spread.sizes().maxCoeff(&axis);
  return int(axis);
}

/// Appends the node over these items and all nodes below it; returns its index. Ties are broken by
/// the items' numbers.
int Builder::add(int first, int count) {
  const int node = int(tree.nodes.size());
  tree.nodes.push_back({bounds(first, count), first, count, -1});
  if (count <= leaf) return node;
  const int axis = longest_side(first, count), half = count / 2;
  const auto begin = tree.order.begin() + first;
  std::nth_element(begin, begin + half, begin + count, [&](int i, int j) {
    return centres[i][axis] != centres[j][axis] ? centres[i][axis] < centres[j][axis] : i < j;
  });
  add(first, half);
  const int right = add(first + half, count - half);
  tree.nodes[node].right = right;
  return node;
}

}  // namespace

BoxTree make_box_tree(const std::vector<Bounds>& boxes, int leaf) {
  std::vector<Vector3> centres;
  centres.reserve(boxes.size());
  for (const Bounds& box : boxes) centres.push_back(box.center());
  Builder builder{boxes, centres, leaf, {}};
  builder.tree.order.resize(boxes.size());
  std::iota(builder.tree.order.begin(), builder.tree.order.end(), 0);
  builder.add(0, int(boxes.size()));
  return std::move(builder.tree);
}

std::vector<Bounds> triangle_bounds(const PerParticle3& x, const std::vector<Triangle>& triangles) {
  std::vector<Bounds> boxes(triangles.size());
  for (size_t t = 0; t < triangles.size(); ++t)
    for (const int v : triangles[t]) boxes[t].extend(Vector3(x.col(v)));
  return boxes;
}

Bounds bounds_of(const PerParticle3& x) {
  return Bounds(x.rowwise().minCoeff(), x.rowwise().maxCoeff());
}

}  // namespace foldproof
