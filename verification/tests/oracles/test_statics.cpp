// Statics of strips and rigidities of meshes, each compared with a second way.
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

TEST_CASE("the loaded tip by elliptic integrals is that of shooting, and the table's") {
  const std::array<std::array<double, 3>, 3> table{
      {{1, .05643324, .30172077}, {4, .32894124, .66996418}, {10, .55499560, .81060902}}};
  for (const auto& [alpha, shortening, drop] : table) {
    const LoadedTip tip = tip_load(alpha), other = tip_load_by_shooting(alpha);
    CHECK(std::abs(1 - tip.reach.value - shortening) < 5.1e-9 + tip.reach.uncertainty);
    CHECK(std::abs(tip.drop.value - drop) < 5.1e-9 + tip.drop.uncertainty);
    CHECK(tip.drop.uncertainty < 1e-10);
    CHECK(std::abs(tip.drop.value - other.drop.value) <=
          tip.drop.uncertainty + other.drop.uncertainty);
    CHECK(std::abs(tip.reach.value - other.reach.value) <=
          tip.reach.uncertainty + other.reach.uncertainty);
    CHECK(other.drop.uncertainty < 1e-8);
  }
  CHECK(std::abs(tip_load(1e-3).drop.value / (1e-3 / 3) - 1) < 1e-5);
  CHECK_THROWS_AS(tip_load(std::nan("")), InputError);
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

namespace {

/// w of a periodic mesh's vertices on a quadratic surface: the energy of whole cells, hinge by
/// hinge, from normals in space.
double angle_by_normals(const std::array<Eigen::Vector3d, 4>& x) {
  const Eigen::Vector3d above = (x[0] - x[2]).cross(x[0] - x[3]).normalized(),
                        below = (x[1] - x[3]).cross(x[1] - x[2]).normalized();
  return std::atan2(above.cross(below).norm(), above.dot(below));
}

}  // namespace

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

TEST_CASE("union jack and criss-cross are one mesh, turned by 45 degrees") {
  const PeriodicMesh jack =
      split_rectangles({1, 1, 2, 2, [](int i, int j) { return (i + j) % 2 == 0; }});
  for (const double angle : {.1, .9, 2.2}) {
    CHECK(std::abs(cylinder_rigidity(forced_rigidity(jack), angle) -
                   cylinder_rigidity(forced_rigidity(crossed_squares(1)), angle + pi / 4)) < 1e-12);
    CHECK(std::abs(cylinder_rigidity(relaxed_rigidity(jack), angle) -
                   cylinder_rigidity(relaxed_rigidity(crossed_squares(1)), angle + pi / 4)) <
          1e-12);
  }
}

TEST_CASE("one hinge of a plane sheet turns by the angle between its normals") {
  PlaneSheet sheet;
  sheet.points.resize(2, 4);
  sheet.points << .4, .7, 0, 1.1, .9, -.6, 0, .2;
  sheet.hinges = {{0, 1, 2, 3}};
  sheet.counted = {1};
  sheet.held = {1, 1, 1, 1};
  const double angle = .6, curvature = 1e-5;
  std::array<Eigen::Vector3d, 4> x;
  for (int i = 0; i < 4; ++i) {
    const double s = std::cos(angle) * sheet.points(0, i) + std::sin(angle) * sheet.points(1, i);
    x[size_t(i)] = Eigen::Vector3d(sheet.points(0, i), sheet.points(1, i), curvature * s * s / 2);
  }
  const double areas =
      (x[0] - x[2]).cross(x[0] - x[3]).norm() + (x[1] - x[3]).cross(x[1] - x[2]).norm();
  const double factor = (x[3] - x[2]).squaredNorm() / areas,
               theta = angle_by_normals(x) / curvature;
  const double expected = factor / 2 * theta * theta / (areas / 6);
  CHECK(std::abs(forced_cylinder_rigidity(sheet, angle) / expected - 1) < 1e-8);
  CHECK(relaxed_cylinder_rigidity(sheet, angle) == forced_cylinder_rigidity(sheet, angle));
  sheet.held = {0, 1, 1, 1};
  CHECK(std::abs(relaxed_cylinder_rigidity(sheet, angle)) < 1e-12);
  std::swap(sheet.hinges[0][0], sheet.hinges[0][1]);
  CHECK_THROWS_AS(forced_cylinder_rigidity(sheet, angle), InputError);
}
