// The tree of boxes, worked out by hand.
#include <array>
#include <catch2/catch.hpp>

#include "reference/mesh/box_tree.h"

using namespace foldproof;

TEST_CASE("a tree of boxes is cut at the medians of the longest sides, ties by the numbers") {
  const auto tree_of = [](const std::vector<Vector3>& centres, int leaf) {
    std::vector<Bounds> boxes;
    for (const Vector3& centre : centres)
      boxes.push_back({centre - Vector3(0.25, 0.5, 1), centre + Vector3(0.25, 0.5, 1)});
    return make_box_tree(boxes, leaf);
  };
  // along x first: 1, 4 | 2, 0, 3; then 1 | 4 along y, and 2 | 0, 3 along z
  const std::vector<Vector3> centres{{9, 0, 1}, {0, 3, 0}, {8, 0, -2}, {9, 0, 2}, {1, 5, 0}};
  const BoxTree tree = tree_of(centres, 1);
  CHECK(tree.order == std::vector<int>{1, 4, 2, 0, 3});
  std::vector<std::array<int, 3>> nodes;
  for (const BoxNode& node : tree.nodes) nodes.push_back({node.first, node.count, node.right});
  const std::vector<std::array<int, 3>> by_hand{{0, 5, 4},  {0, 2, 3},  {0, 1, -1},
                                                {1, 1, -1}, {2, 3, 6},  {2, 1, -1},
                                                {3, 2, 8},  {3, 1, -1}, {4, 1, -1}};
  CHECK(nodes == by_hand);
  CHECK(tree.nodes[0].bounds.isApprox(Bounds(Vector3(-0.25, -0.5, -3), Vector3(9.25, 5.5, 3)), 0));
  CHECK(tree.nodes[6].bounds.isApprox(Bounds(Vector3(8.75, -0.5, 0), Vector3(9.25, 0.5, 3)), 0));
  CHECK(tree_of(centres, 2).nodes.size() == 5);
  CHECK(tree_of(std::vector(7, centres[0]), 1).order == std::vector{0, 1, 2, 3, 4, 5, 6});
}
