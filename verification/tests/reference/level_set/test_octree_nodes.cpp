// Nodes of an octree: their places, means of corners, the interpolant of a cell, which nodes hang.
#include <catch2/catch.hpp>

#include <functional>
#include <map>
#include <set>

#include "reference/level_set/octree_nodes.h"
#include "verification/specimens/random.h"

using namespace foldproof;

namespace {

using Key = std::array<int, 4>;  // level, then x, y, z among the cells of that level

Key key_of(const OctreePlace& place) {
  return {place.level, place.cell[0], place.cell[1], place.cell[2]};
}

/// A tree of branches alone; those that it has, breadth first.
struct Branches {
  Octree tree;
  std::vector<OctreePlace> places;
  std::map<Key, int> index;
};

/// The cube, and each cell that `is_branch` accepts in a branch.
Branches branches_where(int depth, const std::function<bool(const OctreePlace&)>& is_branch) {
  Branches all;
  all.tree.settings.depth = depth;
  all.places.push_back({0, {0, 0, 0}});
  for (std::size_t b = 0; b < all.places.size(); ++b) {
    const OctreePlace place = all.places[b];
    all.index[key_of(place)] = int(b);
    OctreeBranch branch{int(all.places.size()), 0, 0, 0};
    for (int c = 0; c < 8; ++c) {
      OctreePlace child{place.level + 1, {}};
      for (int axis = 0; axis < 3; ++axis)
        child.cell[axis] = 2 * place.cell[axis] + (c >> axis) % 2;
      if (child.level >= depth || !is_branch(child)) continue;
      branch.inner = static_cast<unsigned char>(branch.inner + (1 << c));
      all.places.push_back(child);
    }
    all.tree.branches.push_back(branch);
  }
  return all;
}

Branches random_branches(unsigned seed, int depth, double share) {
  Random random(seed);
  return branches_where(depth, [&](const OctreePlace&) { return random.uniform(0, 1) < share; });
}

/// Is there a leaf as wide as the branch, or a wider one's part of that width, that has the
/// branch's node in the middle of an edge or a face?
bool hangs(const Branches& all, const OctreePlace& place, const std::array<int, 3>& at) {
  const int cells = 1 << place.level;
  for (int x = 0; x < cells; ++x)
    for (int y = 0; y < cells; ++y)
      for (int z = 0; z < cells; ++z) {
        if (all.index.count({place.level, x, y, z})) continue;
        const std::array<int, 3> cell{x, y, z};
        int middles = 0;
        bool touches = true;
        for (int axis = 0; axis < 3; ++axis) {
          const int offset = 2 * place.cell[axis] + at[axis] - 2 * cell[axis];  // in half a width
          touches = touches && 0 <= offset && offset <= 2;
          middles += offset == 1;
        }
        if (touches && (middles == 1 || middles == 2)) return true;
      }
  return false;
}

template <class T>
T mean_of_corners(const BranchNodes<T>& nodes, const std::array<int, 3>& at, const T& zero) {
  T sum = zero;
  int count = 0;
  for (const int x : {0, 2})
    for (const int y : {0, 2})
      for (const int z : {0, 2}) {
        if ((at[0] != 1 && at[0] != x) || (at[1] != 1 && at[1] != y) || (at[2] != 1 && at[2] != z))
          continue;
        sum += nodes[x + 3 * y + 9 * z];
        ++count;
      }
  return sum / count;
}

std::array<int, 3> steps_of(int n) { return {n % 3, n / 3 % 3, n / 9}; }

}  // namespace

TEST_CASE("nodes lie on the lattice of their level, from the cube's corner") {
  OctreeSettings settings{};
  settings.corner = {-0.75, 0.5, 2.25};
  settings.width = 4;
  CHECK(lattice_position(settings, 3, {1, 5, 6}) == Vector3(-0.25, 3, 5.25));
  const OctreePlace place{2, {3, 1, 2}};
  for (int n = 0; n < 27; ++n) {
    const auto [x, y, z] = steps_of(n);
    CHECK(node_position(settings, place, n) ==
          Vector3(-0.75 + 3 + 0.5 * x, 0.5 + 1 + 0.5 * y, 2.25 + 2 + 0.5 * z));
  }
}

TEST_CASE("children lie at the lower or upper half along each axis") {
  const OctreePlace place{2, {3, 1, 2}};
  for (int c = 0; c < 8; ++c) {
    const OctreePlace child = child_place(place, c);
    CHECK(child.level == 3);
    CHECK(child.cell == std::array<int, 3>{6 + c % 2, 2 + c / 2 % 2, 4 + c / 4});
    CHECK(first_corner(c) == c % 2 + 3 * (c / 2 % 2) + 9 * (c / 4));
  }
  for (int k = 0; k < 8; ++k) CHECK(corner_steps[k] == k % 2 + 3 * (k / 2 % 2) + 9 * (k / 4));
}

TEST_CASE("a branch's inner children are numbered one after the other") {
  for (int inner = 0; inner < 256; ++inner) {
    const OctreeBranch branch{41, 0, static_cast<unsigned char>(inner), 1};
    int next = 41;
    for (int c = 0; c < 8; ++c)
      if (inner >> c & 1) CHECK(inner_child(branch, c) == next++);
  }
}

TEST_CASE("each branch knows its place, whatever the tree's shape") {
  for (const unsigned seed : {941u, 942u}) {
    const Branches all = random_branches(seed, 4, 0.45);
    REQUIRE(all.places.size() > 20);
    const std::vector<OctreePlace> places = branch_places(all.tree);
    REQUIRE(places.size() == all.places.size());
    for (std::size_t b = 0; b < places.size(); ++b)
      CHECK(key_of(places[b]) == key_of(all.places[b]));
  }
}

TEST_CASE("a node's mean is that of the corners about it, itself at a corner") {
  Random random(943);
  BranchNodes<double> values;
  BranchNodes<Vector3> vectors;
  for (int n = 0; n < 27; ++n) {
    values[n] = random.uniform(-1, 2);
    vectors[n] = random.vectors(1, 3).col(0);
  }
  for (int n = 0; n < 27; ++n) {
    CHECK(corner_mean(values, n) ==
          Approx(mean_of_corners(values, steps_of(n), 0.0)).epsilon(1e-14));
    const Vector3 expected = mean_of_corners(vectors, steps_of(n), Vector3(0, 0, 0));
    CHECK((corner_mean(vectors, n) - expected).norm() < 1e-14);
  }
}

TEST_CASE("hanging nodes are set to the mean of their corners, the others are left alone") {
  Random random(944);
  BranchNodes<double> before;
  for (double& value : before) value = random.uniform(-1, 2);
  for (int n = 0; n < 27; ++n) {
    const bool is_corner = corner_mean(before, n) == before[n];
    BranchNodes<double> after = before;
    constrain(1u << n, after);
    for (int other = 0; other < 27; ++other)
      CHECK(after[other] == (other == n && !is_corner ? corner_mean(before, n) : before[other]));
  }
}

TEST_CASE("a cell's interpolant and its slope are the trilinear ones of its eight corners") {
  Random random(945);
  BranchNodes<double> nodes;
  for (double& value : nodes) value = random.uniform(-1, 2);
  for (int c = 0; c < 8; ++c) {
    const Vector3 t(random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1));
    double value = 0;
    Vector3 slope = Vector3::Zero();
    for (int k = 0; k < 8; ++k) {
      const std::array<int, 3> upper{k % 2, k / 2 % 2, k / 4};
      const double corner =
          nodes[(c % 2 + upper[0]) + 3 * (c / 2 % 2 + upper[1]) + 9 * (c / 4 + upper[2])];
      std::array<double, 3> weight;
      for (int axis = 0; axis < 3; ++axis) weight[axis] = upper[axis] ? t[axis] : 1 - t[axis];
      value += weight[0] * weight[1] * weight[2] * corner;
      for (int axis = 0; axis < 3; ++axis)
        slope[axis] +=
            (upper[axis] ? 1 : -1) * weight[(axis + 1) % 3] * weight[(axis + 2) % 3] * corner;
    }
    const Trilinear found = trilinear(nodes, c, t);
    CHECK(found.value == Approx(value).epsilon(1e-13));
    CHECK((found.slope - slope).norm() < 1e-13);
  }
}

TEST_CASE("a node hangs in the middle of an edge or a face of a leaf as wide as its branch") {
  for (const unsigned seed : {946u, 947u, 948u, 949u}) {
    const Branches all = random_branches(seed, 4, seed % 2 ? 0.4 : 0.8);
    int hanging_in_all = 0;
    for (const OctreePlace& place : all.places) {
      const std::uint32_t hanging = hanging_nodes(all.tree, place);
      std::uint32_t expected = 0;
      for (int n = 0; n < 27; ++n)
        if (hangs(all, place, steps_of(n))) expected += 1u << n;
      CHECK(hanging == expected);
      hanging_in_all += expected != 0;
    }
    CHECK(hanging_in_all > 0);
  }
}

TEST_CASE("nothing hangs in a tree of a single branch, nor where all cells are split alike") {
  const Branches one = branches_where(3, [](const OctreePlace&) { return false; });
  CHECK(hanging_nodes(one.tree, one.places[0]) == 0);
  const Branches all = branches_where(3, [](const OctreePlace&) { return true; });
  REQUIRE(all.places.size() == 1 + 8 + 64);
  for (const OctreePlace& place : all.places) CHECK(hanging_nodes(all.tree, place) == 0);
}
