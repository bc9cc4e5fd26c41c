// Queries of an octree: the union's distance and flags.
#include <catch2/catch.hpp>

#include <cmath>
#include <functional>

#include "reference/level_set/octree_nodes.h"

using namespace foldproof;

namespace {

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
