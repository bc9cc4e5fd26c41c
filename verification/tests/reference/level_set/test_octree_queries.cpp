// Queries of an octree: the interpolant of a cell, starts of descents, the union's distance and
// flags.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "reference/level_set/octree_nodes.h"
#include "verification/specimens/random.h"

using namespace foldproof;

namespace {

using Key = std::array<int, 4>;  // level, then x, y, z among the cells of that level

struct Sample {
  Octree tree;
  std::map<Key, int> index;  // of each branch
};

/// The cube, and each cell of a branch that `is_branch` accepts; without channels.
Sample tree_where(int depth, const std::function<bool(const Key&)>& is_branch) {
  Sample all;
  Octree& tree = all.tree;
  tree.settings.corner = {-0.75, 0.5, 2.25};
  tree.settings.width = 4;
  tree.settings.depth = depth;
  std::vector<Key> places{{0, 0, 0, 0}};
  for (std::size_t b = 0; b < places.size(); ++b) {
    const Key place = places[b];
    all.index[place] = int(b);
    OctreeBranch branch{int(places.size()), 0, 0, 0};
    for (int c = 0; c < 8; ++c) {
      const Key child{place[0] + 1, 2 * place[1] + c % 2, 2 * place[2] + c / 2 % 2,
                      2 * place[3] + c / 4};
      if (child[0] >= depth || !is_branch(child)) continue;
      branch.inner = static_cast<unsigned char>(branch.inner + (1 << c));
      places.push_back(child);
    }
    tree.branches.push_back(branch);
  }
  index_descent_starts(tree);
  return all;
}

/// So many branches, and no more.
Sample tree_of(int branches) {
  int left = branches - 1;
  return tree_where(4, [&](const Key&) { return left-- > 0; });
}

/// One branch with one channel for each function of the node's position.
Octree single_branch(const std::vector<std::function<double(const Vector3&)>>& parts) {
  Octree tree;
  tree.settings.corner = {-0.75, 0.5, 2.25};
  tree.settings.width = 4;
  tree.settings.depth = 1;
  tree.branches.push_back({1, 0, 0, static_cast<unsigned char>(parts.size())});
  for (const auto& part : parts) {
    tree.part.push_back(10 + int(tree.part.size()));
    BranchNodes<double>& phi = tree.phi.emplace_back();
    for (int n = 0; n < 27; ++n) phi[n] = part(node_position(tree.settings, {0, {0, 0, 0}}, n));
  }
  index_descent_starts(tree);
  return tree;
}

/// Planes x = 1, y = 2 and z = 3, each with the solid below it.
Octree three_planes() {
  return single_branch({[](const Vector3& p) { return p.x() - 1; },
                        [](const Vector3& p) { return p.y() - 2; },
                        [](const Vector3& p) { return p.z() - 3; }});
}

}  // namespace

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

TEST_CASE("descents start at the deepest level with no more cells than there are branches") {
  for (const auto& [branches, level] :
       {std::pair{1, 0}, {7, 0}, {8, 1}, {9, 1}, {63, 1}, {64, 2}}) {
    Sample all = tree_of(branches);
    index_descent_starts(all.tree);  // for the second time
    REQUIRE(all.tree.branches.size() == std::size_t(branches));
    CHECK(all.tree.start_level == level);
    const int cells = 1 << level;
    REQUIRE(all.tree.starts.size() == std::size_t(cells * cells * cells));
    for (int x = 0; x < cells; ++x)
      for (int y = 0; y < cells; ++y)
        for (int z = 0; z < cells; ++z) {
          Key cell{level, x, y, z};
          while (!all.index.count(cell))
            cell = {cell[0] - 1, cell[1] / 2, cell[2] / 2, cell[3] / 2};
          const OctreeStart start = all.tree.starts[x + cells * (y + cells * z)];
          CHECK(start.branch == all.index.at(cell));
          CHECK(start.level == cell[0]);
        }
  }
}

TEST_CASE("beyond the cube distances count from the surface below the cube's nearest point") {
  const Octree tree = three_planes();
  const Vector3 p(4.25, 2.75, 3.5);  // a metre beyond
  const NearestParts found = nearest_parts(tree, p);
  CHECK(found.first_part == 12);
  CHECK(found.second_part == 11);
  CHECK(found.inside == 0);
  for (const Distance& first : {found.first, tree.at(p)}) {
    CHECK(first.phi == Approx(std::hypot(1, 0.5)).epsilon(1e-14));
    CHECK((first.normal - Vector3(1, 0, 0.5).normalized()).norm() < 1e-14);
  }
  CHECK(found.second.phi == Approx(1.25).epsilon(1e-14));
  CHECK((found.second.normal - Vector3(0.8, 0.6, 0)).norm() < 1e-14);
}

TEST_CASE("of parts at one distance the first channel is nearest, and none contains its surface") {
  const Octree tree = three_planes();
  const Vector3 p(1.5, 2.5, 3.5);
  CHECK(tree.at(p).phi == 0.5);
  CHECK(tree.at(p).normal == Vector3(1, 0, 0));
  CHECK(nearest_parts(tree, p).first_part == 10);
  CHECK(nearest_parts(tree, p).second_part == 11);
  CHECK(nearest_parts(tree, {1, 2.5, 3.5}).inside == 0);
  CHECK(nearest_parts(tree, {1, 1.5, 3.5}).inside == 1);
  CHECK(nearest_parts(tree, {0.5, 1.5, 2.5}).inside == 3);
}

TEST_CASE("a cell without slope has a normal, as has a point on the surface beyond the cube") {
  const Vector3 p(1.3, 2.7, 3.9);
  CHECK(single_branch({[](const Vector3&) { return 0.7; }}).at(p).normal == Vector3(0, 0, 1));
  const Octree gentle = single_branch({[](const Vector3& q) { return 1e-3 * (q.y() - q.x()); }});
  CHECK((gentle.at(p).normal - Vector3(-1, 1, 0).normalized()).norm() < 1e-12);
  // the surface at x = 3.75, half a metre beyond the cube
  const Octree tree = single_branch({[](const Vector3& q) { return q.x() - 3.75; }});
  for (const double x : {3.75, 4.0}) {
    CHECK(tree.at({x, 2, 3}).phi == x - 3.75);
    CHECK(tree.at({x, 2, 3}).normal == Vector3(1, 0, 0));
  }
  CHECK(std::isnan(tree.at({0.3, NAN, 2.5}).phi));
}

TEST_CASE("a node on the surfaces of two parts belongs to the first and is not pinched") {
  const Octree tree = single_branch({[](const Vector3& p) { return p.x() - 1.25; },
                                     [](const Vector3& p) { return p.y() - 2.5; }});
  const NodeFlags centre = node_flags(tree, 0)[13];
  CHECK(centre.part == 10);
  CHECK_FALSE(centre.pinched);
  CHECK(node_flags(tree, 0)[0].pinched);
  CHECK_FALSE(node_flags(tree, 0)[3].pinched);  // y at the surface
  CHECK_FALSE(node_flags(tree, 0)[26].pinched);
}
