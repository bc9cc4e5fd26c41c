// Statics of strips, plates and meshes of hinges: tables, counts by hand, and refused meshes.
#include <Eigen/Dense>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "reference/types.h"
#include "verification/oracles/homogenised_bending.h"
#include "verification/oracles/sheets/growing_ring.h"
#include "verification/oracles/sheets/sagging_plate.h"
#include "verification/oracles/tip_load.h"

using namespace foldproof;
using namespace foldproof::oracles;

TEST_CASE("the loaded tip by elliptic integrals is the table's") {
  const std::array<std::array<double, 3>, 3> table{
      {{1, .05643324, .30172077}, {4, .32894124, .66996418}, {10, .55499560, .81060902}}};
  for (const auto& [alpha, shortening, drop] : table) {
    const LoadedTip tip = tip_load(alpha);
    CHECK(std::abs(1 - tip.reach.value - shortening) < 5.1e-9 + tip.reach.uncertainty);
    CHECK(std::abs(tip.drop.value - drop) < 5.1e-9 + tip.drop.uncertainty);
    CHECK(tip.drop.uncertainty < 1e-10);
  }
  CHECK(std::abs(tip_load(1e-3).drop.value / (1e-3 / 3) - 1) < 1e-5);
}

TEST_CASE("a narrow ring of plate sags as a cantilever") {
  // by width^4/8; the ring grows outward and is bent around, each by the next power
  for (const double width : {2e-3, 7e-3})
    CHECK(std::abs(8 * sag_of_ring_by_formula({1 - width, 0.3}).value / std::pow(width, 4) - 1) <
          2 * width);
}

TEST_CASE("hinges on finer and finer rings sag as a plate does, to the second order") {
  const GrowingRing coarse{36, 4, 0.37}, fine{100, 12, 0.37};
  REQUIRE(std::abs(coarse.edge() / fine.edge() - 1) < 1e-14);
  const double plate = sag_of_ring_by_formula({fine.plate / fine.edge(), poisson_of_hinges}).value;
  const double off = 1 - sag_of_hinges(coarse) / plate, less = 1 - sag_of_hinges(fine) / plate;
  CHECK(off > 0);
  CHECK(off < 0.03);
  CHECK(std::abs(std::log(off / less) / std::log(12.5 / 4.5) - 2) < 0.1);
}

TEST_CASE("homogenised rigidities are the table's") {
  const PeriodicMesh alternating =
      split_rectangles({.7, .7, 1, 2, [](int, int j) { return j % 2 == 0; }});
  const PeriodicMesh union_jack =
      split_rectangles({1.3, 1.3, 2, 2, [](int i, int j) { return (i + j) % 2 == 0; }});
  struct Row {
    PeriodicMesh mesh;
    std::array<double, 4> relaxed;  // at 0, 45, 90, 135 degrees
    double tolerance;               // of the table's last digit
  };
  const std::array<Row, 6> table{
      {{equilateral_triangles(.3), {.25, .25, .25, .25}, 1e-12},
       {split_rectangles({}), {.25, .75, .25, .25}, 1e-12},
       {alternating, {.25, .4375, .25, .4375}, 1e-12},
       {union_jack, {.2083, .3333, .2083, .3333}, 5e-5},
       {crossed_squares(2.1), {.3333, .2083, .3333, .2083}, 5e-5},
       {split_rectangles({4, 1, 1, 1, nullptr}), {.25, 2.789, .25, 1.727}, 5e-4}}};
  for (const Row& row : table) {
    const Eigen::Matrix3d R = relaxed_rigidity(row.mesh);
    for (size_t k = 0; k < 4; ++k)
      CHECK(std::abs(cylinder_rigidity(R, double(k) * pi / 4) - row.relaxed[k]) <= row.tolerance);
    const Eigen::Matrix3d stiffer = forced_rigidity(row.mesh) - R;
    CHECK(stiffer.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff() > -1e-12);
  }
  const Eigen::Matrix3d one_diagonal = relaxed_rigidity(split_rectangles({}));
  CHECK(std::abs(cylinder_range(one_diagonal).least - .1875) < 2e-6);
  CHECK(std::abs(cylinder_range(one_diagonal).greatest - .75) < 2e-6);
  CHECK(std::abs(strip_rigidity(one_diagonal, 0) - .2) < 1e-12);
  CHECK(std::abs(strip_rigidity(relaxed_rigidity(equilateral_triangles(1)), .4) - 2. / 9) < 1e-12);
}

TEST_CASE("a cylinder's rigidity takes the twist twice, and a strip curves freely across") {
  Eigen::Matrix3d R;
  R << 2, .3, .1, .3, 1.5, -.2, .1, -.2, .7;
  for (const double angle : {0., .4, 1.9}) {
    const double c = std::cos(angle), s = std::sin(angle);
    const Eigen::Vector3d k(c * c, s * s, 2 * c * s), n(c * c, s * s, c * s);
    CHECK(cylinder_rigidity(R, angle) == Approx(k.dot(R * k)).epsilon(1e-14));
    CHECK(strip_rigidity(R, angle) == Approx(1 / n.dot(R.inverse() * n)).epsilon(1e-13));
  }
}

TEST_CASE("the range of rigidities holds all directions, and touches both its ends") {
  Eigen::Matrix3d level = Eigen::Vector3d(2, .5, .3).asDiagonal(), turned;
  CHECK(cylinder_range(level).greatest == 2);  // at no angle
  CHECK(cylinder_range(level).least == Approx(.5).epsilon(2e-6));
  // the greatest lies between two eighths of a turn beyond a right angle
  turned << .5, 0, -.2, 0, .5, -.2, -.2, -.2, .3;
  const RigidityRange range = cylinder_range(turned);
  CHECK(range.greatest == Approx(cylinder_rigidity(turned, 3 * pi / 4)).epsilon(2e-6));
  CHECK(range.least == Approx(cylinder_rigidity(turned, pi / 4)).epsilon(2e-6));
}

TEST_CASE("a periodic mesh must close, with one triangle on each side of each edge") {
  PeriodicMesh open = equilateral_triangles(1), doubled = open, over = open, thin = open;
  open.triangles.pop_back();
  doubled.triangles.push_back(doubled.triangles[0]);
  for (auto& triangle : over.triangles) std::swap(triangle[0], triangle[1]);
  thin.period_b = Eigen::Vector2d(.5, 0);
  CHECK_THROWS_WITH(forced_rigidity(open), Catch::Contains("an edge has one triangle"));
  CHECK_THROWS_WITH(relaxed_rigidity(doubled), Catch::Contains("two triangles on one side"));
  CHECK_THROWS_WITH(forced_rigidity(over), Catch::Contains("no area or is turned over"));
  CHECK_THROWS_AS(forced_rigidity(thin), InputError);
  CHECK_THROWS_WITH(equilateral_ribbon(1, 1), Catch::Contains("a ribbon needs two rows"));
}

TEST_CASE("hinges of a sheet turn by the angle between normals, and weigh by their areas") {
  PlaneSheet sheet;
  sheet.points.resize(2, 5);
  sheet.points << .4, .6, 0, 1.1, 1.7, .8, -.5, 0, .2, .9;
  sheet.hinges = {{0, 1, 2, 3}, {2, 4, 3, 0}};
  sheet.held = {1, 1, 1, 1, 1};
  const double angle = .6, curvature = 1e-5;
  double energy = 0, weights = 0;
  for (std::size_t k = 0; k < 2; ++k) {
    std::array<Eigen::Vector3d, 4> x;
    for (std::size_t i = 0; i < 4; ++i) {
      const Eigen::Vector2d p = sheet.points.col(sheet.hinges[k][i]);
      const double s = std::cos(angle) * p.x() + std::sin(angle) * p.y();
      x[i] = Eigen::Vector3d(p.x(), p.y(), curvature * s * s / 2);
    }
    const Eigen::Vector3d above = (x[0] - x[2]).cross(x[0] - x[3]),
                          below = (x[1] - x[3]).cross(x[1] - x[2]);
    const double areas = above.norm() + below.norm(), factor = (x[3] - x[2]).squaredNorm() / areas,
                 theta = std::atan2(above.cross(below).norm(), above.dot(below)) / curvature;
    const double expected = factor / 2 * theta * theta;
    sheet.counted = {k == 0, k == 1};
    CHECK(forced_cylinder_rigidity(sheet, angle) == Approx(expected / (areas / 6)).epsilon(1e-8));
    energy += expected;
    weights += areas / 6;
  }
  sheet.counted = {1, 1};
  const double held = forced_cylinder_rigidity(sheet, angle);
  CHECK(held == Approx(energy / weights).epsilon(1e-8));
  CHECK(relaxed_cylinder_rigidity(sheet, angle) == Approx(held).epsilon(1e-14));
  sheet.held[0] = 0;
  CHECK(relaxed_cylinder_rigidity(sheet, angle) < held * (1 - 1e-3));
  CHECK(relaxed_cylinder_rigidity(sheet, angle) > 1e-3);
  sheet.held[4] = 0;
  CHECK(std::abs(relaxed_cylinder_rigidity(sheet, angle)) < 1e-12);
  std::swap(sheet.hinges[0][0], sheet.hinges[0][1]);
  CHECK_THROWS_AS(forced_cylinder_rigidity(sheet, angle), InputError);
}

// Every hinge: theta = (w1 + w2 - w3 - w4)/h, c = l/(2 h). A period has four slanting hinges and
// one of the middle row; the outer rows' edges have none. Bending, w = x^2/2: a slanting hinge
// turns by l^2/(2 h), wherever its rows are shifted; a shift makes the middle one flat. Twisting,
// w = x y/2: the slanting ones turn by l/2, the middle one does not.
TEST_CASE("a ribbon of two rows is as stiff as its three kinds of hinges") {
  const double edge = .7, h = edge * std::sqrt(.75), c = edge / (2 * h);
  const RibbonRigidity two = equilateral_ribbon(edge, 2);
  CHECK(two.bending ==
        Approx(c / 2 * 4 * std::pow(edge * edge / (2 * h), 2) / edge).epsilon(1e-13));
  CHECK(two.twisting == Approx(4 * c / 2 * 4 * std::pow(edge / 2, 2) / edge).epsilon(1e-13));
}
