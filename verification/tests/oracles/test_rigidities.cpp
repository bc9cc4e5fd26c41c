// Strips, plates and meshes of hinges: tables, and counts by hand; the equation of a whole sheet.
#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "reference/types.h"
#include "verification/oracles/cloth.h"
#include "verification/oracles/elastica.h"
#include "verification/oracles/gsl.h"
#include "verification/oracles/heavy_cantilever.h"
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

TEST_CASE("elliptic integrals and shooting agree on a loaded tip, and know how sure they are") {
  for (const double alpha : {.01, .7, 6., 37., 100.}) {
    const LoadedTip one = tip_load(alpha), other = tip_load_by_shooting(alpha);
    for (const auto& [p, q] :
         {std::pair{one.drop, other.drop}, std::pair{one.reach, other.reach}}) {
      CHECK(std::abs(p.value - q.value) <= p.uncertainty + q.uncertainty);
      CHECK(p.uncertainty >= 1e-13);
      CHECK(p.uncertainty < 1e-9);
      CHECK(q.uncertainty > 1e-14);
      CHECK(q.uncertainty < 2e-7);
    }
  }
}

TEST_CASE("the heavy cantilever's tip is the table's") {
  const std::array<std::array<double, 3>, 5> table{{{1, .1234714020, .9912463953},
                                                    {5, .4959050446, .8466571800},
                                                    {10, .7001997155, .6563537612},
                                                    {100, .9375239354, .1592233826},
                                                    {1e4, .9941099339, .0142608898}}};
  for (const auto& [gamma, drop, reach] : table) {
    const CantileverTip tip = heavy_cantilever(gamma);
    CHECK(std::abs(tip.drop.value - drop) <= 5e-11 + tip.drop.uncertainty);
    CHECK(std::abs(tip.reach.value - reach) <= 5e-11 + tip.reach.uncertainty);
    CHECK(std::max(tip.drop.uncertainty, tip.reach.uncertainty) < 5e-11);  // the table's last digit
  }
  const auto slope = [](double gamma) {
    return heavy_cantilever(gamma).drop.value / heavy_cantilever(gamma).reach.value;
  };
  CHECK(std::abs(slope(1e-3) * 8 / 1e-3 - 1) < 1e-6);
  const double test_angle = std::tan(41.5 * pi / 180);
  const Estimate gamma =
      bracketed_root([&](double g) { return slope(g) - test_angle; }, 7, 9, 1e-9);
  CHECK(std::abs(gamma.value - 8.004197) < 5.1e-7);
}

TEST_CASE("loops without weight are as high as Peirce printed") {
  const auto height = [&](double first_slope, double turn) {
    const StripShape shape =
        strip_by_collocation({0, first_slope, {{first_slope + turn, 0, 0}}, 0}, std::array{.5});
    return -shape.points[0].up;
  };
  CHECK(std::abs(height(0, -2 * pi) - 1 / pi) < 1e-11);       // ring: a circle
  CHECK(std::abs(height(-pi / 2, -pi) - .4243) < 5e-5);       // pear loop
  CHECK(std::abs(height(pi / 2, -3 * pi) - .1337) < 2.5e-4);  // heart loop; ours is .13386
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

TEST_CASE("free particles of a sheet obey Newton's second law, pushed by particle and time") {
  ClothDefinition cloth;
  cloth.masses = {.3, .7, 1.1};
  cloth.springs = {{2, 0, .9, .17}};
  cloth.material.young = 53;
  cloth.material.spring_damping = .31;
  cloth.gravity = Vector3(.4, -.9, -9.7);
  cloth.external_force = [](int particle, double t) {
    return Vector3(particle + .5, t, particle * t);
  };
  cloth.prescribed[0] = harmonic_motion({{.1, .2, .3}, {.4, .5, .6}, .7, .8});
  const double t = .29, angle = 2 * pi * .7 * t + .8;
  const Vector3 x0 = Vector3(.1, .2, .3) + std::sin(angle) * Vector3(.4, .5, .6),
                v0 = 2 * pi * .7 * std::cos(angle) * Vector3(.4, .5, .6);
  const std::array<double, 12> y{1.1, -.4, .6, 2.3, .9, -.7, .31, .53, -.29, -.83, .47, .61};
  std::array<double, 12> dy;
  cloth_rhs(cloth)(t, y, dy);
  for (std::size_t k = 0; k < 6; ++k) CHECK(dy[k] == y[6 + k]);
  const Vector3 d = x0 - Vector3(2.3, .9, -.7), n = d.normalized(),
                closing = v0 - Vector3(-.83, .47, .61);
  const Vector3 spring =
      (53 * .17 / .9 * (d.norm() / .9 - 1) + .31 * .17 / (.9 * .9) * closing.dot(n)) * n;
  const Vector3 first = cloth.gravity + Vector3(1.5, t, t) / .7,
                second = cloth.gravity + (spring + Vector3(2.5, t, 2 * t)) / 1.1;
  for (int k = 0; k < 3; ++k) {
    CHECK(dy[std::size_t(6 + k)] == Approx(first[k]).epsilon(1e-14));
    CHECK(dy[std::size_t(9 + k)] == Approx(second[k]).epsilon(1e-14));
  }
}
