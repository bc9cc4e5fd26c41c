// Parts of bodies that a grid loses: which are named, and which are not accused.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "reference/bodies/thin_parts.h"
#include "reference/mesh/shapes.h"
#include "reference/scene/object_surface.h"

using namespace foldproof;
using Catch::Matchers::Contains;

namespace {

const GridMethod method{48, 4, 3, MarchingOrder::second};

TriangleSoup box(const Vector3& half, const Vector3& centre = Vector3::Zero()) {
  ObjectSurface surface = box_surface(half);
  surface.vertices.colwise() += centre;
  return {std::move(surface.vertices), std::move(surface.triangles), {}};
}

TriangleSoup join(TriangleSoup a, const TriangleSoup& b) {
  const int first = int(a.rest.cols());
  a.rest.conservativeResize(3, first + b.rest.cols());
  a.rest.rightCols(b.rest.cols()) = b.rest;
  for (const Triangle& t : b.triangles)
    a.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  return a;
}

/// A cone 1 m high, its apex twice the angle wide.
TriangleSoup cone(double degrees) {
  const double radius = std::tan(degrees * pi / 180);
  TriangleSoup soup{PerParticle3::Zero(3, 42), {}, {}};
  soup.rest(1, 40) = 1;
  for (int k = 0; k < 40; ++k) {
    soup.rest.col(k) = radius * Vector3(std::cos(pi * k / 20), 0, std::sin(pi * k / 20));
    soup.triangles.push_back({k, 40, (k + 1) % 40});
    soup.triangles.push_back({k, (k + 1) % 40, 41});
  }
  return soup;
}

TriangleSoup rotated(TriangleSoup soup, double angle) {
  const PerParticle3 x =
      Eigen::AngleAxisd(angle, Vector3(1, 0.3, 0.5).normalized()).toRotationMatrix() * soup.rest;
  soup.rest = x;
  return soup;
}

std::optional<ThinParts> lost(const TriangleSoup& soup) {
  return find_thin_parts(soup.rest, soup.triangles, *make_level_set(soup, method, Repair::refuse));
}

}  // namespace

TEST_CASE("plates, shells, fins and hair below a cell are lost, with their place and thickness") {
  for (const double angle : {0.0, 0.05, 0.4}) {
    // cells are 10 mm or more
    const auto plate = lost(rotated(box({0.25, 0.0005, 0.25}), angle));
    REQUIRE(plate);
    CHECK(plate->lost > 0.5);
    CHECK(std::abs(plate->thickness - 0.001) < 1e-6);
    CHECK(lost(rotated(box({0.25, 0.0025, 0.25}), angle)));
    CHECK(!lost(rotated(box({0.25, 0.008, 0.25}), angle)));
  }
  const TriangleSoup whole = box({0.5, 0.5, 0.5});
  const auto shell = lost(join(whole, box({-0.499, -0.499, -0.499})));
  REQUIRE(shell);
  CHECK(shell->lost > 0.9);
  const auto fin = lost(join(whole, box({0.1, 0.2, 0.001}, {0.7, 0.1, 0.1})));
  REQUIRE(fin);
  CHECK(fin->lost < 0.1);
  CHECK((fin->place - Vector3(0.7, 0.1, 0.1)).cwiseAbs().maxCoeff() < 0.201);
  const std::string text =
      describe(*fin, *make_level_set(whole, method, Repair::refuse), 1.3, Repair::refuse);
  CHECK_THAT(text, Contains("about 0.002 m thick") && Contains("\"exact\" or \"octree\""));
  CHECK(lost(join(whole, box({0.002, 0.2, 0.002}, {0.113, 0.9, 0.087}))));  // a hair
}

TEST_CASE("edges, tips and round bodies are not accused of being thin") {
  PerParticle3 x(3, 4);
  x << 1, 1, -1, -1, 1, -1, 1, -1, 1, -1, -1, 1;
  const TriangleSoup tetrahedron{x, {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}}, {}};
  const TriangleMesh ball = make_icosphere(0.7, 3), statue = make_statue(1, 3);
  for (const double angle : {0.0, 0.4}) {
    CHECK(!lost(rotated(box({0.5, 0.1, 0.3}), angle)));
    CHECK(!lost(rotated(tetrahedron, angle)));
    CHECK(!lost(rotated({ball.rest, ball.triangles, {}}, angle)));
    CHECK(!lost(rotated({statue.rest, statue.triangles, {}}, angle)));
    for (const double degrees : {9.0, 15.0, 30.0, 60.0})
      CHECK(!lost(rotated(cone(degrees), angle)));
    const auto needle = lost(rotated(cone(2), angle));
    if (needle) CHECK(needle->lost < 0.5);
  }
}
