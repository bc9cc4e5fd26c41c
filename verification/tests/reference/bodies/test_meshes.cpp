// Bodies: meshes that are refused as solids, their inspection and deformations.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "reference/bodies/body_deformation.h"
#include "reference/bodies/closed_mesh.h"
#include "reference/bodies/mesh_inspection.h"
#include "reference/bodies/ray_parity.h"
#include "reference/bodies/repair.h"
#include "reference/mesh/shapes.h"

using namespace foldproof;
using Catch::Matchers::Contains;
using Catch::Matchers::Equals;

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

double ball_volume() {
  const TriangleMesh unit = make_icosphere(1, 1);
  double sum = 0;  // of the pyramids over the triangles
  for (const Triangle& t : unit.triangles)
    sum += (Eigen::Matrix3d() << unit.rest.col(t[0]), unit.rest.col(t[1]), unit.rest.col(t[2]))
               .finished()
               .determinant() /
           6;
  return sum;
}

const Vector3 here(0.3, -1.4, 2.2), there(5.1, 0.7, -3.2);

}  // namespace

TEST_CASE("pieces are numbered in the order of their first triangles") {
  const TriangleSoup soup = soup_of({{1, here, false}, {2, there, false}, {1, -there, false}});
  TriangleMesh mesh = make_closed_mesh(soup);
  std::vector<int> expected;
  for (int k = 0; k < 240; ++k) expected.push_back(k / 80);
  CHECK(pieces_of(mesh) == expected);

  // triangles of two pieces in turn; the borders of sheets join nothing
  std::vector<Triangle> mixed;
  for (size_t t = 0; t < 80; ++t)
    for (const size_t k : {2, 0}) mixed.push_back(soup.triangles[80 * k + 79 - t]);
  mesh = make_mesh_of_fans(
      (PerParticle3(3, 84) << soup.rest.leftCols(42), soup.rest.rightCols(42)).finished(), [&] {
        for (Triangle& t : mixed)
          for (int& v : t) v -= v >= 84 ? 42 : 0;
        return mixed;
      }());
  for (size_t t = 0; t < 160; ++t) expected[t] = int(t % 2);
  expected.resize(160);
  CHECK(pieces_of(mesh) == expected);
  const TriangleMesh sheet = make_sheet({SheetPattern::one_diagonal, 1, 0.6, 3, 2});
  CHECK(pieces_of(sheet) == std::vector<int>(12, 0));
}

TEST_CASE("the volume is that of the pyramids, less where normals point inward") {
  const TriangleSoup soup = soup_of({{3, here, false}, {2, here, true}, {0.5, there, false}});
  CHECK(enclosed_volume(soup.rest, soup.triangles) ==
        Approx((27 - 8 + 0.125) * ball_volume()).epsilon(1e-12));
}

TEST_CASE("holes are counted with their edges, and the first is named") {
  TriangleSoup soup = soup_of({{1, here, false}, {2, there, false}});
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
  const Triangle gone = soup.triangles[90];
  int a = std::min({gone[0], gone[1], gone[2]}), b = 1 << 30, beside = -1;
  for (const int v : gone)
    if (v != a) b = std::min(b, v);
  for (size_t t = 0; t < soup.triangles.size(); ++t) {
    const Triangle& own = soup.triangles[t];
    if (t != 90 && std::count(own.begin(), own.end(), a) && std::count(own.begin(), own.end(), b))
      beside = int(t) - (t > 90 ? 1 : 0);
  }
  CHECK_THROWS_WITH(
      make_closed_mesh(remove({90})),
      Contains("mesh: triangle " + std::to_string(beside) + ": a hole: the edge between vertex " +
               std::to_string(a) + " and vertex " + std::to_string(b) + ", at (" +
               std::to_string(soup.rest(0, a)).substr(0, 4)));
}

TEST_CASE("intersecting triangles are counted, and the first pair is named") {
  // a small ball on the surface of a large one
  const TriangleSoup soup =
      soup_of({{1, here, false}, {0.05, here + Vector3(0.7, 0.61, 0.2), false}});
  try {
    make_closed_mesh(soup);
    FAIL("pieces that meet");
  } catch (const InputError& error) {
    const std::string text = error.what();
    int s = -1, t = -1;
    long pairs = 0;
    REQUIRE(std::sscanf(text.c_str(), "mesh: triangle %d: meets triangle %d near", &t, &s) == 2);
    CHECK(s < 80);
    CHECK(t >= 80);
    const size_t at = text.find("the first of ");
    REQUIRE(at != std::string::npos);
    pairs = std::stol(text.substr(at + 13));
    CHECK(pairs > 1);
    CHECK_THAT(text, Contains("intersecting pairs; mend it, or set repair = \"winding\""));
    const Vector3 corner = soup.rest.col(soup.triangles[size_t(t)][0]);
    char place[64];
    std::snprintf(place, sizeof place, "near (%.4g, %.4g, %.4g)", corner.x(), corner.y(),
                  corner.z());
    CHECK_THAT(text, Contains(place));
  }
}

TEST_CASE("pieces face outward, or inward around a cavity, wherever they lie") {
  const auto made = [](const std::vector<Ball>& balls) { make_closed_mesh(soup_of(balls)); };
  CHECK_NOTHROW(made({{3, here, false}, {2, here, true}, {1, here, false}}));
  CHECK_NOTHROW(made({{2, here, true}, {3, here, false}, {0.5, there, false}}));
  const std::string remedy =
      "; reverse the order of its triangles' vertices, or set repair = \"winding\"";
  const std::string start =
      ": the piece of 80 triangles that begins here is inside out: its normals point ";
  CHECK_THROWS_WITH(made({{1, here, true}}),
                    Equals("mesh: triangle 0" + start + "inward" + remedy));
  CHECK_THROWS_WITH(made({{1, here, false}, {1, there, true}}),
                    Equals("mesh: triangle 80" + start + "inward" + remedy));
  CHECK_THROWS_WITH(made({{1, there, false}, {3, here, false}, {2, here, false}}),
                    Equals("mesh: triangle 160" + start +
                           "outward, though it lies within another piece" + remedy));
  // a ball turned inward within a cavity has nothing around it to be hollowed out
  CHECK_THROWS_WITH(made({{3, here, false}, {2, here, true}, {1, here, true}}),
                    Contains("mesh: triangle 160"));
}

TEST_CASE("an inspection counts vertices, pieces and nodes, and says why a mesh is no solid") {
  const MeshInspection none;
  CHECK(none.vertices + none.triangles + none.pieces + none.nodes == 0);
  CHECK(none.against_sign + none.among_rays == 0);
  CHECK(none.volume == 0);

  TriangleSoup soup = soup_of({{0.9, here, false}, {0.4, there, false}});
  const MeshInspection whole = inspect_mesh(soup, 24);
  CHECK(whole.vertices == 84);
  CHECK(whole.triangles == 160);
  CHECK(whole.pieces == 2);
  CHECK(whole.volume == Approx((0.729 + 0.064) * ball_volume()));
  CHECK(whole.rejection.empty());
  CHECK(whole.repair_failure.empty());
  CHECK(whole.bounds.min() == Vector3(soup.rest.rowwise().minCoeff()));
  CHECK(whole.bounds.max() == Vector3(soup.rest.rowwise().maxCoeff()));
  CHECK(whole.nodes == lattice_about(whole.bounds, 24, 4).size());
  CHECK(whole.against_sign == 0);
  CHECK(whole.among_rays == 0);

  soup.triangles.erase(soup.triangles.begin() + 3);
  const MeshInspection open = inspect_mesh(soup, 24);
  CHECK_THAT(open.rejection, Contains("1 hole"));
  CHECK(open.pieces == 0);
  CHECK(open.volume == 0);
  CHECK(open.repair_failure.empty());
  CHECK(open.nodes == whole.nodes);
  CHECK(open.among_rays > 0);

  // within two balls that face outward rays cross an even number of triangles
  const MeshInspection twice = inspect_mesh(soup_of({{3, here, false}, {2, here, false}}), 16);
  CHECK(twice.against_sign > 100);
  CHECK(twice.repair_failure.empty());

  const MeshInspection inward = inspect_mesh(soup_of({{0.9, here, true}}), 12);
  CHECK_THAT(inward.rejection, Contains("inside out"));
  CHECK_THAT(inward.repair_failure, Contains("repair finds no inside"));
  CHECK(inward.nodes == 0);
}

TEST_CASE("an inspection leaves out nodes within a millionth of a cell of the surface, no others") {
  // a box without half of its floor, under which the vertical rays begin: those beyond the roof,
  // 5e-5 cells above it, disagree with the others
  PerParticle3 x(3, 8);
  for (int k = 0; k < 8; ++k) x.col(k) = Vector3(k & 1, (k & 2) / 2, k & 4 ? 1 - 1e-5 : 0);
  const TriangleSoup soup{x,
                          {{0, 2, 1},
                           {4, 5, 6},
                           {5, 7, 6},
                           {0, 1, 4},
                           {1, 5, 4},
                           {2, 6, 3},
                           {3, 6, 7},
                           {0, 4, 2},
                           {2, 4, 6},
                           {1, 3, 5},
                           {3, 7, 5}},
                          {}};
  const MeshInspection found = inspect_mesh(soup, 10);
  const auto grid = make_level_set(soup, {10, 4, 3, MarchingOrder::second}, Repair::winding);
  const auto parity = ray_parity(soup.rest, soup.triangles, grid->lattice);
  const auto counted = [&](double skin) {
    return long(disagreement(*grid, parity, skin * grid->lattice.spacing).among_rays.size());
  };
  CHECK(found.among_rays == counted(1e-6));
  CHECK(found.among_rays > counted(1e-3));
  CHECK(found.against_sign ==
        long(disagreement(*grid, parity, 1e-6 * grid->lattice.spacing).with_sign.size()));
}

namespace {

const Bounds box(Vector3(-0.7, 0.4, -1.1), Vector3(0.9, 2.9, 0.5));

Vector3 deformed(std::vector<BodyDeformation> parts, const Vector3& X, double t) {
  return deformation_of(std::move(parts), box)(X, t);
}

}  // namespace

TEST_CASE("a bent body's axis is an arc of its own length, and what is beside it turns with it") {
  // a third of the period: 3/4 of the amplitude; the axis starts at (0.1, 0.4, -0.3), 2.5 m high
  const Vector3 base(0.1, 0.4, -0.3);
  for (const double amplitude : {1.3, -0.8}) {
    for (const double height : {0.3, 1.9}) {
      const double curvature = 0.75 * amplitude / 2.5, phi = curvature * height;
      const Vector3 axis((1 - std::cos(phi)) / curvature, std::sin(phi) / curvature, 0);
      const Vector3 beside(0.6 * std::cos(phi), -0.6 * std::sin(phi), -0.4);
      CHECK((deformed({{DeformationKind::bend, amplitude, 0.9}}, base + Vector3(0.6, height, -0.4),
                      0.3) -
             base - axis - beside)
                .norm() < 1e-14);
    }
    const Vector3 foot = base + Vector3(0.6, 0, -0.4);
    CHECK((deformed({{DeformationKind::bend, amplitude, 0.9}}, foot, 0.3) - foot).norm() < 1e-15);
  }
  const Vector3 top = base + Vector3(0.6, 2.5, -0.4);
  CHECK((deformed({{DeformationKind::bend, 1.3, 0.9}}, top, 0) - top).norm() < 1e-15);
  CHECK((deformed({{DeformationKind::bend, 1.3, 0.9}}, top, 1.8) - top).norm() < 1e-13);
}

TEST_CASE("a twisted body turns in proportion to the height") {
  const Vector3 base(0.1, 0.4, -0.3), X(0.6, 1.9, -0.4);
  const double turn = 0.75 * 1.3 * 1.9 / 2.5;
  const Vector3 expected = Eigen::AngleAxisd(turn, Vector3::UnitY()) * X;
  CHECK((deformed({{DeformationKind::twist, 1.3, 0.9}}, base + X, 0.6) - base - expected).norm() <
        1e-14);
}

TEST_CASE("a breathing body widens most at mid-height") {
  const Vector3 base(0.1, 0.4, -0.3);
  for (const auto& [height, share] : {std::pair{1.25, 1.0}, {2.0, 0.64}, {0.25, 0.36}}) {
    const double factor = 1 + 0.3 * share;  // half the period: the whole amplitude
    CHECK(
        (deformed({{DeformationKind::breathe, 0.3, 0.9}}, base + Vector3(0.6, height, -0.4), 0.45) -
         base - Vector3(0.6 * factor, height, -0.4 * factor))
            .norm() < 1e-14);
  }
}

TEST_CASE("deformations follow each other in their order, and unknown ones are refused") {
  const Vector3 X(0.6, 1.9, -0.4);
  const BodyDeformation bend{DeformationKind::bend, 1.3, 0.9},
      twist{DeformationKind::twist, -0.7, 1.7};
  CHECK(
      (deformed({bend, twist}, X, 0.4) - deformed({twist}, deformed({bend}, X, 0.4), 0.4)).norm() <
      1e-14);
  CHECK(deformed({}, X, 0.4).isApprox(X));
  CHECK_THROWS_WITH(deformed({{DeformationKind(7), 1, 1}}, X, 0.4), Contains("no such kind"));
}
