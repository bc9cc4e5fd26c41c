// The tree of boxes: every node against its definition.
#include <algorithm>
#include <catch2/catch.hpp>
#include <numeric>
#include <random>

#include "reference/mesh/box_tree.h"

using namespace foldproof;

namespace {

/// Boxes of different sizes about centres that lie farthest apart along `axis`.
std::vector<Bounds> random_boxes(int count, int axis, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> inside(-0.5, 0.5), half_side(0.01, 0.9);
  std::vector<Bounds> boxes;
  for (int i = 0; i < count; ++i) {
    Vector3 centre(inside(random) + 3.7, inside(random) - 1.3, inside(random) + 0.4);
    centre[axis] += 17 * inside(random);
    const Vector3 half(half_side(random), half_side(random), half_side(random));
    boxes.push_back({centre - half, centre + half});
  }
  return boxes;
}

/// Follows the definition from the root down, with items sorted where the tree only parts them.
struct Walk {
  const std::vector<Bounds>& boxes;
  const BoxTree& tree;
  size_t leaf;
  size_t visited = 0;  // nodes

  void follow(std::vector<int> items) {
    const BoxNode& node = tree.nodes.at(visited++);
    REQUIRE(size_t(node.count) == items.size());
    std::vector<int> held(tree.order.begin() + node.first,
                          tree.order.begin() + node.first + node.count);
    std::ranges::sort(held);
    std::ranges::sort(items);
    REQUIRE(held == items);
    Bounds all, centres;
    for (const int i : items) {
      all = all.merged(boxes[size_t(i)]);
      centres.extend((boxes[size_t(i)].min() + boxes[size_t(i)].max()) / 2);
    }
    CHECK(node.bounds.min() == all.min());
    CHECK(node.bounds.max() == all.max());
    if (items.size() <= leaf) {
      CHECK(node.right == -1);
      return;
    }
    const Vector3 sides = centres.max() - centres.min();
    const int axis = sides.x() >= sides.y() && sides.x() >= sides.z() ? 0
                     : sides.y() >= sides.z()                         ? 1
                                                                      : 2;
    std::ranges::stable_sort(items, {}, [&](int i) { return boxes[size_t(i)].center()[axis]; });
    const auto middle = items.begin() + long(items.size() / 2);
    const int first = node.first, right = node.right;
    CHECK(tree.nodes.at(visited).first == first);
    follow({items.begin(), middle});
    CHECK(right == int(visited));
    CHECK(tree.nodes.at(visited).first == first + int(items.size() / 2));
    follow({middle, items.end()});
  }
};

void check_tree(const std::vector<Bounds>& boxes, int leaf) {
  const BoxTree tree = make_box_tree(boxes, leaf);
  std::vector<int> items(boxes.size());
  std::iota(items.begin(), items.end(), 0);
  REQUIRE(tree.order.size() == boxes.size());
  Walk walk{boxes, tree, size_t(leaf)};
  walk.follow(items);
  CHECK(walk.visited == tree.nodes.size());
}

}  // namespace

TEST_CASE("every node of a tree of boxes is cut at the median along its longest side") {
  for (const int axis : {0, 1, 2})
    for (const int count : {1, 2, 3, 4, 7, 29})
      for (const int leaf : {1, 3, 4}) check_tree(random_boxes(count, axis, 61), leaf);
}

TEST_CASE("boxes with one centre are parted by their numbers") {
  std::vector<Bounds> boxes;
  for (int i = 0; i < 13; ++i) {
    const Vector3 half(0.25 + i, 1.75 * (13 - i), 0.5);  // centres are exact
    boxes.push_back({Vector3(5, -3, 2) - half, Vector3(5, -3, 2) + half});
  }
  check_tree(boxes, 1);
  const BoxTree tree = make_box_tree(boxes, 1);
  for (int i = 0; i < 13; ++i) CHECK(tree.order[size_t(i)] == i);
  std::swap(boxes[2], boxes[9]);
  boxes[4].translate(Vector3(0, -0.75, 0));
  boxes[6].translate(Vector3(0, 0.875, 0));
  check_tree(boxes, 1);
}

TEST_CASE("a tree of three boxes is the one worked out by hand") {
  const auto box = [](double x) {
    return Bounds(Vector3(x - 0.2, 0.1, -0.3), Vector3(x + 0.4, 0.7, 1.1));
  };
  const BoxTree tree = make_box_tree({box(9), box(3), box(5)}, 1);
  CHECK(tree.order == std::vector<int>{1, 2, 0});
  REQUIRE(tree.nodes.size() == 5);  // all; the 1st; the others; the 2nd; the 0th
  const std::vector<std::array<int, 3>> by_hand{
      {0, 3, 2}, {0, 1, -1}, {1, 2, 4}, {1, 1, -1}, {2, 1, -1}};
  for (size_t k = 0; k < 5; ++k)
    CHECK(std::array<int, 3>{tree.nodes[k].first, tree.nodes[k].count, tree.nodes[k].right} ==
          by_hand[k]);
  CHECK(tree.nodes[2].bounds.min() == Vector3(4.8, 0.1, -0.3));
  CHECK(tree.nodes[2].bounds.max() == Vector3(9.4, 0.7, 1.1));
}

TEST_CASE("bounds of triangles hold their three corners and no more") {
  PerParticle3 x(3, 5);
  x << 0.3, -1.7, 2.9, 0.8, 11,  //
      1.1, 0.2, -0.6, 4.3, 13,   //
      -2.2, 0.7, 0.5, 1.9, 17;
  const std::vector<Bounds> boxes = triangle_bounds(x, {{0, 2, 1}, {3, 1, 2}});
  REQUIRE(boxes.size() == 2);
  CHECK(boxes[0].min() == Vector3(-1.7, -0.6, -2.2));
  CHECK(boxes[0].max() == Vector3(2.9, 1.1, 0.7));
  CHECK(boxes[1].min() == Vector3(-1.7, -0.6, 0.5));
  CHECK(boxes[1].max() == Vector3(2.9, 4.3, 1.9));
  CHECK(bounds_of(x.leftCols(4)).min() == Vector3(-1.7, -0.6, -2.2));
  CHECK(bounds_of(x.leftCols(4)).max() == Vector3(2.9, 4.3, 1.9));
}
