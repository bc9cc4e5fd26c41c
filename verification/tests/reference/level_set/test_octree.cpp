// Octrees: settings, growth and queries.
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

#include "reference/level_set/octree.h"
#include "reference/level_set/octree_growth.h"
#include "reference/level_set/octree_nodes.h"

using namespace foldproof;
using Catch::Contains;

namespace {

OctreeSettings sampling(int depth) {
  return {{0, 0, 0}, 1, depth, 2, 3e-3, 0.05, 0.2, 0.03, HangingNodes::free};
}

DistanceFunction constant(double phi) {
  return [phi](const Vector3&) { return Distance{phi, Vector3::Zero()}; };
}

}  // namespace

TEST_CASE("a cell is split where it misses by more than is allowed, not by just as much") {
  // 8, and 1/4 more at odd nodes along x
  const DistanceFunction bumps = [](const Vector3& p) {
    return Distance{8 + 0.25 * (int(p.x()) % 2), Vector3::Zero()};
  };
  OctreeSettings settings = sampling(2);
  settings.width = 4;
  settings.surface_depth = 0;
  const auto branches = [&](double tolerance, double beyond, double band) {
    settings.tolerance = tolerance;
    settings.beyond = beyond;
    settings.band = band;
    return make_octree({bumps}, settings).branches.size();
  };
  CHECK(branches(0.25, 0, 0) == 1);
  CHECK(branches(std::nextafter(0.25, 0.0), 0, 0) == 9);
  // 1/16 + (8.25 - 6.75)/8
  CHECK(branches(0.0625, 0.125, 6.75) == 1);
  CHECK(branches(0.0625, 0.125, 6.75 + 1e-6) == 9);
  // in the band nothing is taken off
  CHECK(branches(0.25, 0.125, 20) == 1);
}

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

}  // namespace

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

namespace {

/// The distance to a point, and a little more.
DistanceFunction point_at(const Vector3& place, double more) {
  return [=](const Vector3& p) { return Distance{(p - place).norm() + more, Vector3::Zero()}; };
}

OctreeSettings usable() {
  return {{0.25, -0.5, 0.75}, 0.5, 2, 1, 0.01, 0.02, 0.1, 0.03, HangingNodes::constrained};
}

/// A tree of the depth about a point of its cube, given by its place among 8 cells along each axis.
void check_boundary(const Vector3& eighths, int depth, bool is_on_boundary) {
  OctreeSettings settings = usable();
  settings.depth = depth;
  settings.surface_depth = depth;
  const Vector3 place = settings.corner + settings.width * (eighths / 8);
  for (const HangingNodes hanging : {HangingNodes::free, HangingNodes::constrained}) {
    settings.hanging = hanging;
    if (is_on_boundary)
      CHECK_THROWS_WITH(make_octree({constant(3), point_at(place, 0)}, settings),
                        Contains("octree: body 1 reaches the boundary of the cube"));
    else
      CHECK_NOTHROW(make_octree({constant(3), point_at(place, 0)}, settings));
    CHECK_NOTHROW(make_octree({constant(3), point_at(place, 1e-9)}, settings));
  }
}

}  // namespace

TEST_CASE("a body that reaches a node of the cube's boundary is refused, one inside is not") {
  for (int x = 0; x <= 8; x += 4)
    for (int y = 0; y <= 8; y += 4)
      for (int z = 0; z <= 8; z += 4)
        check_boundary(Vector3(x, y, z), 1, x != 4 || y != 4 || z != 4);
  OctreeSettings settings = usable();
  settings.depth = settings.surface_depth = 3;
  const Vector3 centre = settings.corner + Vector3::Constant(0.25);
  CHECK_NOTHROW(make_octree({point_at(centre, -0.24)}, settings));
  CHECK_THROWS_WITH(make_octree({point_at(centre, -0.25)}, settings), Contains("body 0 reaches"));
}

TEST_CASE("a body that reaches the boundary between wide cells' nodes is found by narrow ones") {
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {0.0, 8.0}) {
      Vector3 place(3, 5, 3);
      if (axis == 1) place = {5, 3, 5};
      place[axis] = side;
      check_boundary(place, 3, true);
      place[axis] = side == 0 ? 1 : 7;
      check_boundary(place, 3, false);
    }
}
