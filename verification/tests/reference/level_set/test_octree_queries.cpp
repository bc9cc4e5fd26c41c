// Queries of an octree: the leaf of a point, the union's distance, flags and sizes, on trees of any
// shape with values that are no distances.
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

/// The cube, and each cell of a branch that `is_branch` accepts; one to three channels a branch.
Sample tree_where(unsigned seed, int depth, const std::function<bool(const Key&)>& is_branch) {
  Random random(seed);
  Sample all;
  Octree& tree = all.tree;
  tree.settings.corner = {-0.75, 0.5, 2.25};
  tree.settings.width = 4;
  tree.settings.depth = depth;
  std::vector<Key> places{{0, 0, 0, 0}};
  for (std::size_t b = 0; b < places.size(); ++b) {
    const Key place = places[b];
    all.index[place] = int(b);
    const int parts = 1 + int(random.uniform(0, 3));
    OctreeBranch branch{int(places.size()), int(tree.part.size()), 0,
                        static_cast<unsigned char>(parts)};
    for (int k = 0; k < parts; ++k) {
      tree.part.push_back(3 * k + int(random.uniform(0, 3)));
      BranchNodes<double> phi;
      for (double& value : phi) value = random.uniform(-0.5, 1);
      tree.phi.push_back(phi);
    }
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

Sample random_tree(unsigned seed, int depth, double share) {
  Random random(seed);
  return tree_where(seed, depth, [&](const Key&) { return random.uniform(0, 1) < share; });
}

/// So many branches, and no more.
Sample tree_of(int branches) {
  int left = branches - 1;
  return tree_where(951, 4, [&](const Key&) { return left-- > 0; });
}

struct SlowLeaf {
  Key cell;  // its level and place
  int branch, child;
  Vector3 local;
};

SlowLeaf slow_leaf(const Sample& all, const Vector3& p) {
  const OctreeSettings& cube = all.tree.settings;
  for (int level = 0;; ++level) {
    Key cell{level, 0, 0, 0};
    for (int axis = 0; axis < 3; ++axis) {
      const int place = int(std::floor((p[axis] - cube.corner[axis]) / cube.width * (1 << level)));
      cell[axis + 1] = std::min(place, (1 << level) - 1);
    }
    if (all.index.count(cell)) continue;
    SlowLeaf leaf{cell,
                  all.index.at({level - 1, cell[1] / 2, cell[2] / 2, cell[3] / 2}),
                  cell[1] % 2 + 2 * (cell[2] % 2) + 4 * (cell[3] % 2),
                  {}};
    for (int axis = 0; axis < 3; ++axis)
      leaf.local[axis] = (p[axis] - cube.corner[axis]) / cube.width * (1 << level) - cell[axis + 1];
    return leaf;
  }
}

void check_leaf(const Sample& all, const Vector3& p) {
  const OctreeLeaf found = leaf_at(all.tree, p);
  const SlowLeaf expected = slow_leaf(all, p);
  CHECK(found.branch == expected.branch);
  CHECK(found.child == expected.child);
  CHECK(found.level == expected.cell[0]);
  CHECK((found.local - expected.local).norm() < 1e-12);
}

struct Answer {
  Distance distance;
  int part;
};

/// Each channel's answer at p, beyond the cube from the surface point below q, in their order.
std::vector<Answer> slow_answers(const Sample& all, const Vector3& p) {
  const OctreeSettings& cube = all.tree.settings;
  Vector3 q;
  for (int axis = 0; axis < 3; ++axis)
    q[axis] = std::min(std::max(p[axis], cube.corner[axis]), cube.corner[axis] + cube.width);
  const SlowLeaf leaf = slow_leaf(all, q);
  const OctreeBranch& branch = all.tree.branches[leaf.branch];
  std::vector<Answer> answers;
  for (int k = 0; k < branch.parts; ++k) {
    const Trilinear at = trilinear(all.tree.phi[branch.channels + k], leaf.child, leaf.local);
    Distance distance{at.value, at.slope.normalized()};
    if (q != p) {
      const Vector3 way = p - (q - distance.phi * distance.normal);
      distance = {way.norm(), way.normalized()};
    }
    answers.push_back({distance, all.tree.part[branch.channels + k]});
  }
  return answers;
}

Vector3 about_the_cube(Random& random, double beyond) {
  Vector3 p(-0.75, 0.5, 2.25);
  for (int axis = 0; axis < 3; ++axis) p[axis] += random.uniform(-beyond, 4 + beyond);
  return p;
}

/// One branch with one channel for each function of the node's position.
Octree single_branch(const std::vector<std::function<double(const Vector3&)>>& parts) {
  Octree tree;
  tree.settings.corner = {-0.75, 0.5, 2.25};
  tree.settings.width = 4;
  tree.settings.depth = 1;
  tree.branches.push_back({1, 0, 0, static_cast<unsigned char>(parts.size())});
  for (const auto& part : parts) {
    BranchNodes<double> phi;
    for (int n = 0; n < 27; ++n) phi[n] = part(node_position(tree.settings, {0, {0, 0, 0}}, n));
    tree.phi.push_back(phi);
    tree.part.push_back(10 + int(tree.part.size()));
  }
  index_descent_starts(tree);
  return tree;
}

}  // namespace

TEST_CASE("the leaf of a point is found in trees of any shape, on every side of every cell") {
  for (const unsigned seed : {952u, 953u, 954u}) {
    const Sample all = random_tree(seed, 4, seed == 953 ? 0.9 : 0.45);
    const OctreeSettings& cube = all.tree.settings;
    for (int x = 0; x <= 16; ++x)
      for (int y = 0; y <= 16; y += 1 + x % 3)
        for (int z = 0; z <= 16; ++z) check_leaf(all, cube.corner + 0.25 * Vector3(x, y, z));
    Random random(955);
    for (int i = 0; i < 300; ++i) check_leaf(all, about_the_cube(random, 0));
  }
}

TEST_CASE("in a place that is none a leaf is found all the same, and nothing of it is a number") {
  const Sample all = random_tree(952, 4, 0.45);
  CHECK(std::isnan(all.tree.at({0.3, NAN, 2.5}).phi));
}

TEST_CASE("descents start at the deepest level with no more cells than there are branches") {
  for (const auto& [branches, level] :
       {std::pair{1, 0}, {7, 0}, {8, 1}, {9, 1}, {63, 1}, {64, 2}}) {
    const Sample all = tree_of(branches);
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

TEST_CASE("a tree can be prepared for queries again") {
  Sample all = tree_of(64);
  const std::vector<OctreeStart> before = all.tree.starts;
  index_descent_starts(all.tree);
  CHECK(all.tree.start_level == 2);
  REQUIRE(all.tree.starts.size() == before.size());
}

TEST_CASE("a union's distance is that of its nearest part, inside of the cube and beyond") {
  const Sample all = random_tree(956, 3, 0.5);
  Random random(957);
  for (int i = 0; i < 400; ++i) {
    const Vector3 p = about_the_cube(random, i % 2 ? 1.5 : 0);
    const std::vector<Answer> answers = slow_answers(all, p);
    // the part that is nearest at the cube's nearest point
    const Vector3 low(-0.75, 0.5, 2.25), high(3.25, 4.5, 6.25);
    const std::vector<Answer> below = slow_answers(all, p.cwiseMax(low).cwiseMin(high));
    std::size_t nearest = 0;
    for (std::size_t k = 1; k < below.size(); ++k)
      if (below[k].distance.phi < below[nearest].distance.phi) nearest = k;
    const Distance found = all.tree.at(p);
    CHECK(std::abs(found.phi - answers[nearest].distance.phi) < 1e-12);
    CHECK((found.normal - answers[nearest].distance.normal).norm() < 1e-12);
  }
}

TEST_CASE("the two nearest parts of a union are those of least distance, with their numbers") {
  const Sample all = random_tree(958, 3, 0.5);
  Random random(959);
  for (int i = 0; i < 400; ++i) {
    const Vector3 p = about_the_cube(random, i % 2 ? 1.5 : 0);
    std::vector<Answer> answers = slow_answers(all, p);
    const auto inside = std::count_if(answers.begin(), answers.end(),
                                      [](const Answer& a) { return a.distance.phi < 0; });
    std::sort(answers.begin(), answers.end(),
              [](const Answer& a, const Answer& b) { return a.distance.phi < b.distance.phi; });
    const NearestParts found = nearest_parts(all.tree, p);
    CHECK(found.inside == inside);
    CHECK(found.first_part == answers[0].part);
    CHECK(std::abs(found.first.phi - answers[0].distance.phi) < 1e-12);
    CHECK((found.first.normal - answers[0].distance.normal).norm() < 1e-12);
    if (answers.size() < 2) {
      CHECK(found.second_part == -1);
      CHECK(std::isinf(found.second.phi));
      continue;
    }
    CHECK(found.second_part == answers[1].part);
    CHECK(std::abs(found.second.phi - answers[1].distance.phi) < 1e-12);
    CHECK((found.second.normal - answers[1].distance.normal).norm() < 1e-12);
  }
}

TEST_CASE("of parts at one distance the first channel is the nearest") {
  const Octree tree = single_branch({[](const Vector3& p) { return p.x() - 1; },
                                     [](const Vector3& p) { return p.y() - 2; },
                                     [](const Vector3& p) { return p.z() - 3; }});
  const Vector3 p(1.5, 2.5, 3.5);
  CHECK(tree.at(p).phi == 0.5);
  CHECK(tree.at(p).normal == Vector3(1, 0, 0));
  const NearestParts found = nearest_parts(tree, p);
  CHECK(found.first_part == 10);
  CHECK(found.second_part == 11);
  CHECK(found.inside == 0);
}

TEST_CASE("a part contains what lies below its surface, not what lies on it") {
  const Octree tree = single_branch({[](const Vector3& p) { return p.x() - 1; },
                                     [](const Vector3& p) { return p.y() - 2; },
                                     [](const Vector3& p) { return p.z() - 3; }});
  CHECK(nearest_parts(tree, {1, 2.5, 3.5}).inside == 0);
  CHECK(nearest_parts(tree, {1, 1.5, 3.5}).inside == 1);
  CHECK(nearest_parts(tree, {0.5, 1.5, 2.5}).inside == 3);
}

TEST_CASE("before any part was seen there is none, and nothing is inside") {
  const NearestParts none;
  CHECK(none.first_part == -1);
  CHECK(none.second_part == -1);
  CHECK(none.inside == 0);
  CHECK(Octree{}.evaluations == 0);
  CHECK(Octree{}.start_level == 0);
}

TEST_CASE("a cell without slope has a normal, and the least slope gives a unit vector") {
  const Vector3 p(1.3, 2.7, 3.9);
  CHECK(single_branch({[](const Vector3&) { return 0.7; }}).at(p).normal == Vector3(0, 0, 1));
  const Octree gentle = single_branch({[](const Vector3& q) { return 1e-3 * (q.y() - q.x()); }});
  CHECK((gentle.at(p).normal - Vector3(-1, 1, 0).normalized()).norm() < 1e-12);
}

TEST_CASE("beyond the cube a point on the surface has the normal of the cube's nearest point") {
  // the surface at x = 3.75, half a metre beyond the cube
  const Octree tree = single_branch({[](const Vector3& p) { return p.x() - 3.75; }});
  CHECK(tree.at({3.75, 2, 3}).phi == 0);
  CHECK(tree.at({3.75, 2, 3}).normal == Vector3(1, 0, 0));
  CHECK(tree.at({4, 2, 3}).phi == 0.25);
  CHECK(tree.at({4, 2, 3}).normal == Vector3(1, 0, 0));
}

TEST_CASE("a node's flags name its nearest part, and whether two parts contain it") {
  const Sample all = random_tree(960, 3, 0.5);
  int pinched = 0;
  for (std::size_t b = 0; b < all.tree.branches.size(); ++b) {
    const OctreeBranch& branch = all.tree.branches[b];
    const BranchNodes<NodeFlags> flags = node_flags(all.tree, int(b));
    for (int n = 0; n < 27; ++n) {
      std::vector<std::pair<double, int>> sorted;
      int inside = 0;
      for (int k = branch.channels; k < branch.channels + branch.parts; ++k) {
        sorted.push_back({all.tree.phi[k][n], all.tree.part[k]});
        inside += all.tree.phi[k][n] < 0;
      }
      CHECK(flags[n].part == std::min_element(sorted.begin(), sorted.end())->second);
      CHECK(flags[n].pinched == (inside > 1));
      pinched += inside > 1;
    }
  }
  CHECK(pinched > 0);
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

TEST_CASE("a tree's leaves and bytes are counted") {
  for (const int branches : {1, 8, 13}) {
    const Sample all = tree_of(branches);
    CHECK(leaves(all.tree) == std::size_t(8 * branches - (branches - 1)));
    const std::size_t channels = all.tree.part.size(), starts = all.tree.starts.size();
    CHECK(bytes(all.tree) == sizeof(Octree) + branches * sizeof(OctreeBranch) +
                                 channels * (sizeof(int) + 27 * sizeof(double)) +
                                 starts * sizeof(OctreeStart));
  }
}
