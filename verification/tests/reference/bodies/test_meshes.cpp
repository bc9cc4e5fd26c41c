// Bodies: meshes that are refused as solids, and deformations.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "reference/bodies/body_deformation.h"
#include "reference/bodies/closed_mesh.h"
#include "reference/bodies/repair.h"
#include "reference/mesh/shapes.h"

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

TEST_CASE("bodies bend along an arc, twist with the height and breathe at mid-height, in turn") {
  const Bounds box(Vector3(-0.7, 0.4, -1.1), Vector3(0.9, 2.9, 0.5));
  const auto deformed = [&](std::vector<BodyDeformation> parts, const Vector3& X, double t) {
    return deformation_of(std::move(parts), box)(X, t);
  };
  const BodyDeformation twist{DeformationKind::twist, 1.3, 0.9},
      breathe{DeformationKind::breathe, 0.3, 0.9};
  // the axis starts at (0.1, 0.4, -0.3) and is 2.5 m high
  const Vector3 base(0.1, 0.4, -0.3);
  for (const double height : {0.0, 0.25, 1.25, 1.9}) {
    const Vector3 X(0.6, height, -0.4);
    for (const double amplitude : {1.3, -0.8}) {
      const BodyDeformation bend{DeformationKind::bend, amplitude, 0.9};
      // a third of the period: 3/4 of the amplitude
      const double curvature = 0.75 * amplitude / 2.5, phi = curvature * height;
      const Vector3 axis((1 - std::cos(phi)) / curvature, std::sin(phi) / curvature, 0);
      const Vector3 beside(0.6 * std::cos(phi), -0.6 * std::sin(phi), -0.4);
      CHECK((deformed({bend}, base + X, 0.3) - base - axis - beside).norm() < 1e-14);
      CHECK((deformed({bend}, base + X, 1.8) - base - X).norm() < 1e-13);
      CHECK((deformed({bend, twist}, X, 0.4) - deformed({twist}, deformed({bend}, X, 0.4), 0.4))
                .norm() < 1e-14);
    }
    const Vector3 turned = Eigen::AngleAxisd(0.75 * 1.3 * height / 2.5, Vector3::UnitY()) * X;
    CHECK((deformed({twist}, base + X, 0.6) - base - turned).norm() < 1e-14);
    // half the period: the whole amplitude, less the square of the way to mid-height
    const double factor = 1 + 0.3 * (1 - std::pow(height / 1.25 - 1, 2));
    CHECK(
        (deformed({breathe}, base + X, 0.45) - base - Vector3(0.6 * factor, height, -0.4 * factor))
            .norm() < 1e-14);
  }
}
