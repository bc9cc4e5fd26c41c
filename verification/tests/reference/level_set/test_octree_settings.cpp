// Octrees reject settings beyond their limits, too many bodies, and bodies at the cube's boundary.
#include <catch2/catch.hpp>

#include <cmath>
#include <functional>

#include "reference/level_set/octree.h"

using namespace foldproof;
using Catch::Contains;

namespace {

DistanceFunction constant(double phi) {
  return [phi](const Vector3&) { return Distance{phi, Vector3::Zero()}; };
}

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

TEST_CASE("an octree's settings are rejected beyond their limits") {
  struct Limit {
    std::function<void(OctreeSettings&, double)> set;
    std::vector<double> good, bad;
  };
  const std::vector<Limit> limits = {
      {[](auto& s, double v) { s.depth = int(v); }, {1, 20}, {0, 21}},
      {[](auto& s, double v) { s.surface_depth = int(v); }, {0, 2}, {-1, 3}},
      {[](auto& s, double v) { s.width = v; }, {0.01}, {0, NAN}},
      {[](auto& s, double v) { s.tolerance = v; }, {1e-300}, {0, NAN}},
      {[](auto& s, double v) { s.band = v; }, {0}, {-1e-300, NAN}},
      {[](auto& s, double v) { s.beyond = v; }, {0}, {-1e-300, NAN}},
      {[](auto& s, double v) { s.reach = v; }, {0}, {-1e-300, NAN}}};
  for (const Limit& limit : limits) {
    OctreeSettings settings = usable();
    for (const double good : limit.good) {
      limit.set(settings, good);
      CHECK_NOTHROW(make_octree({constant(5)}, settings));
    }
    for (const double bad : limit.bad) {
      limit.set(settings, bad);
      CHECK_THROWS_AS(make_octree({constant(5)}, settings), InputError);
    }
  }
}

TEST_CASE("an octree covers 1 to 255 bodies, each with a channel if it needs one") {
  OctreeSettings settings = usable();
  settings.reach = 6;
  const Octree tree = make_octree(std::vector<DistanceFunction>(255, constant(5)), settings);
  CHECK(int(tree.branches[0].parts) == 255);
  CHECK(tree.part.back() == 254);
  const std::string message = "octree: there must be 1 to 255 bodies";
  CHECK_THROWS_WITH(make_octree(std::vector<DistanceFunction>(256, constant(5)), settings),
                    Contains(message));
  CHECK_THROWS_WITH(make_octree({}, settings), Contains(message));
}

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
