// Meshes of bodies: deformations, holes, thin parts, and the way that they wind.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <random>

#include "reference/bodies/closed_mesh.h"
#include "reference/bodies/repair.h"
#include "reference/bodies/thin_parts.h"
#include "reference/mesh/shapes.h"
#include "reference/scene/object_surface.h"

using namespace foldproof;

using Catch::Matchers::Contains;

namespace {

/// Balls of 80 triangles and 42 vertices each, one after the other; turned ones face inward.
struct Ball {
  double radius;
  Vector3 centre;
  bool turned;
};

TriangleSoup soup_of(const std::vector<Ball>& balls) {
  const TriangleMesh unit = make_icosphere(1, 1);
  TriangleSoup soup{PerParticle3(3, 42 * Eigen::Index(balls.size())), {}, {}};
  for (size_t k = 0; k < balls.size(); ++k) {
    const int first = 42 * int(k);
    soup.rest.middleCols(first, 42) = (balls[k].radius * unit.rest).colwise() + balls[k].centre;
    for (Triangle t : unit.triangles) {
      for (int& v : t) v += first;
      if (balls[k].turned) std::swap(t[1], t[2]);
      soup.triangles.push_back(t);
    }
  }
  return soup;
}

const Vector3 here(0.3, -1.4, 2.2), there(5.1, 0.7, -3.2);

}  // namespace

TEST_CASE("pieces are numbered in the order of their first triangles, and borders join nothing") {
  TriangleSoup soup = soup_of({{1, here, false}, {2, there, false}});
  std::swap(soup.triangles[0], soup.triangles[159]);
  std::vector<int> expected(160, 0);
  std::fill(expected.begin() + 1, expected.begin() + 80, 1);
  expected[159] = 1;
  CHECK(pieces_of(make_closed_mesh(soup)) == expected);
  CHECK(pieces_of(make_sheet({SheetPattern::one_diagonal, 1, 0.6, 3, 2})) ==
        std::vector<int>(12, 0));
}

TEST_CASE("holes are counted with their edges, and the first is named") {
  const TriangleSoup soup = soup_of({{1, here, false}, {2, there, false}});
  const auto remove = [&](std::vector<size_t> which) {
    TriangleSoup open = soup;
    std::sort(which.rbegin(), which.rend());
    for (const size_t t : which) open.triangles.erase(open.triangles.begin() + long(t));
    return open;
  };
  CHECK_THROWS_WITH(make_closed_mesh(remove({90})),
                    Contains("(3 such edges around 1 hole); mend it, or set repair = \"winding\""));
  CHECK_THROWS_WITH(make_closed_mesh(remove({7, 90})),
                    Contains("(6 such edges around 2 holes); mend it"));
  // the first border edge in the order of its vertices, and the triangle on its other side
  CHECK_THROWS_WITH(make_closed_mesh(remove({90})),
                    Contains("mesh: triangle 92: a hole: the edge between vertex 48 and vertex 56, "
                             "at (4.049, 2.401, -3.2)"));
}

TEST_CASE("a piece turned inward within a cavity has nothing around it to be hollowed out") {
  const Ball ball{3, here, false}, cavity{2, here, true};
  CHECK_NOTHROW(make_closed_mesh(soup_of({cavity, ball, {1, here, false}})));
  CHECK_THROWS_WITH(make_closed_mesh(soup_of({ball, cavity, {1, here, true}})),
                    Contains("triangle 160: "));
}

TEST_CASE("pieces inside out are turned for a repair, each with those that it encloses") {
  const auto check = [](const std::vector<Ball>& given, const std::vector<bool>& turned) {
    std::vector<Ball> right = given;
    for (size_t k = 0; k < given.size(); ++k) right[k].turned = turned[k];
    CHECK(outward_patches(soup_of(given)).triangles == soup_of(right).triangles);
  };
  const auto ball = [](double radius, bool turned, const Vector3& centre = here) {
    return Ball{radius, centre, turned};
  };
  check({ball(1, true)}, {false});
  check({ball(1, false, there), ball(2, true), ball(1, true, there / 2)}, {false, false, false});
  check({ball(2, true), ball(3, false)}, {true, false});  // a cavity stays one
  check({ball(2, false), ball(3, true)}, {true, false});  // all inside out
  check({ball(2, true), ball(3, true)}, {false, false});
  check({ball(3, false), ball(2, true), ball(1, true)}, {false, true, false});
  check({ball(1, true), ball(2, false), ball(3, true)}, {false, true, false});
  check({ball(1, false), ball(1, true, here + Vector3(1.7, 0, 0))}, {false, false});  // overlap

  TriangleSoup open = soup_of({ball(1, true)}), right = soup_of({ball(1, false)}), apart = open;
  for (TriangleSoup* bowl : {&open, &right})
    std::erase_if(bowl->triangles, [&](const Triangle& t) { return bowl->rest(2, t[0]) > 2.3; });
  CHECK(open.triangles.size() < 50);
  CHECK(outward_patches(open).triangles == right.triangles);
  // triangles without a common vertex or place
  apart.rest.resize(3, 240);
  for (int t = 0; t < 80; ++t) {
    const Triangle corners = apart.triangles[size_t(t)];
    for (int k = 0; k < 3; ++k)
      apart.rest.col(3 * t + k) = 1.001 * soup_of({ball(1, true)}).rest.col(corners[size_t(k)]) -
                                  0.001 * here - 0.002 * (k - 1) * Vector3(0.3, 0.1, 0.2);
    apart.triangles[size_t(t)] = {3 * t, 3 * t + 1, 3 * t + 2};
  }
  for (const Triangle& t : outward_patches(apart).triangles) CHECK(t[1] == t[0] + 2);
}

TEST_CASE("doubled vertices of a seam join the triangles of a piece") {
  TriangleSoup soup = soup_of({{1, here, false}}), seam = soup;
  seam.rest.conservativeResize(3, 84);
  seam.rest.rightCols(42) = soup.rest;
  for (size_t t = 0; t < 80; t += 2)
    for (int& v : seam.triangles[t]) v += 42;
  const std::vector<Triangle> right = seam.triangles;
  for (const size_t t : {3, 8, 9, 40}) std::swap(seam.triangles[t][1], seam.triangles[t][2]);
  CHECK(orient_triangles(seam) == right);
  CHECK(oriented_patches(seam).patches.size() == 1);
}

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

TEST_CASE("triangles without area, by their shape, are left out of a repair") {
  for (const double size : {1e-4, 1.0, 1e4})
    for (int turn = 0; turn < 3; ++turn) {
      // area over the longest side squared: half of the height
      PerParticle3 x(3, 6);
      x << 0, 1, 0.4, 0, 1, 0.4, 0, 0, 1.9e-12, 0, 0, 2.1e-12, 0, 0, 0, 1, 1, 1;
      const auto turned = [&](int first) {
        return Triangle{first + turn, first + (turn + 1) % 3, first + (turn + 2) % 3};
      };
      const TriangleSoup soup{size * x, {turned(0), turned(3)}, {}};
      CHECK(orient_triangles(soup) == std::vector<Triangle>{turned(3)});
    }
}
