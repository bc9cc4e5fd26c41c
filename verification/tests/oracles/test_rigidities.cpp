// Rigidities of meshes of hinges: what is refused, ribbons against a second count, directions.
#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "reference/types.h"
#include "verification/oracles/homogenised_bending.h"

using namespace foldproof;
using namespace foldproof::oracles;

namespace {

constexpr double root3 = std::numbers::sqrt3;

/// A ribbon of equilateral triangles as a finite sheet: `cells` along x, `rows` across.
PlaneSheet ribbon_sheet(double edge, int rows, int cells) {
  PlaneSheet sheet;
  const double height = edge * root3 / 2;
  const auto vertex = [cells](int i, int j) { return j * (cells + 1) + i; };
  sheet.points.resize(2, (cells + 1) * (rows + 1));
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= cells; ++i)
      sheet.points.col(vertex(i, j)) = Eigen::Vector2d((i + .5 * (j % 2)) * edge, j * height);
  return sheet;
}

Eigen::Matrix3d diagonal(double a, double b, double c) {
  return Eigen::Vector3d(a, b, c).asDiagonal();
}

}  // namespace

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
  // D = 2 c^4 + .5 s^4 + 4 .3 c^2 s^2: stationary in c^2, where 2 c^2 + (.6 - 2 .. ) vanishes
  const RigidityRange range = cylinder_range(diagonal(2, .5, .3));
  double least = INFINITY, greatest = 0;
  for (int i = 0; i <= 100000; ++i) {
    const double p = i * 1e-5, D = 2 * p * p + .5 * (1 - p) * (1 - p) + 1.2 * p * (1 - p);
    least = std::min(least, D);
    greatest = std::max(greatest, D);
  }
  CHECK(range.least == Approx(least).epsilon(2e-6));
  CHECK(range.greatest == Approx(greatest).epsilon(2e-6));
  CHECK(range.greatest == 2);  // at no angle
  CHECK(cylinder_range(diagonal(.5, 2, .6)).least == .5);
  // the greatest lies between two eighths of a turn beyond a right angle
  Eigen::Matrix3d R = diagonal(.5, .5, .3);
  R(0, 2) = R(2, 0) = R(1, 2) = R(2, 1) = -.2;
  const RigidityRange turned = cylinder_range(R);
  CHECK(turned.greatest == Approx(cylinder_rigidity(R, 3 * pi / 4)).epsilon(2e-6));
  CHECK(turned.least == Approx(cylinder_rigidity(R, pi / 4)).epsilon(2e-6));
  CHECK(turned.greatest > turned.least + .1);
}

TEST_CASE("blocks of rectangles repeat with their own widths and heights") {
  const PeriodicMesh mesh =
      split_rectangles({.7, .3, 3, 2, [](int i, int j) { return i == 1 && j == 0; }});
  CHECK(mesh.period_a == Eigen::Vector2d(3 * .7, 0));
  CHECK(mesh.period_b == Eigen::Vector2d(0, 2 * .3));
  REQUIRE(mesh.sites.size() == 6);
  CHECK(mesh.sites[4] == Eigen::Vector2d(.7, .3));  // by rows
  REQUIRE(mesh.triangles.size() == 12);
  double area = 0;
  for (const std::array<PeriodicCorner, 3>& triangle : mesh.triangles) {
    std::array<Eigen::Vector2d, 3> x;
    for (std::size_t k = 0; k < 3; ++k)
      x[k] = mesh.sites[std::size_t(triangle[k].site)] + triangle[k].along_a * mesh.period_a +
             triangle[k].along_b * mesh.period_b;
    const Eigen::Vector2d u = x[1] - x[0], w = x[2] - x[0];
    const double twice = u.x() * w.y() - u.y() * w.x();
    CHECK(twice == Approx(.7 * .3).epsilon(1e-14));  // half a rectangle each, counter-clockwise
    area += twice / 2;
  }
  CHECK(area == Approx(6 * .7 * .3).epsilon(1e-14));
  // the middle one of the lower row rises, its neighbour falls
  CHECK(mesh.triangles[2][2].site == 5);
  CHECK(mesh.triangles[0][2].site == 3);
}

TEST_CASE("meshes of one shape are as stiff whatever their size, but not their proportions") {
  for (const double size : {.2, 3.1}) {
    CHECK((relaxed_rigidity(crossed_squares(size)) - relaxed_rigidity(crossed_squares(1))).norm() <
          1e-13);
    CHECK((forced_rigidity(equilateral_triangles(size)) - forced_rigidity(equilateral_triangles(1)))
              .norm() < 1e-13);
    CHECK((relaxed_rigidity(split_rectangles({2 * size, size, 1, 1, nullptr})) -
           relaxed_rigidity(split_rectangles({2, 1, 1, 1, nullptr})))
              .norm() < 1e-13);
  }
  // x and y change places with the sides
  const Eigen::Matrix3d wide = forced_rigidity(split_rectangles({2, 1, 1, 1, nullptr})),
                        high = forced_rigidity(split_rectangles({1, 2, 1, 1, nullptr}));
  CHECK(wide(0, 2) == Approx(high(1, 2)).epsilon(1e-13));
  CHECK(wide(1, 2) == Approx(high(0, 2)).epsilon(1e-13));
  CHECK(wide(2, 2) == Approx(high(2, 2)).epsilon(1e-13));
  CHECK(std::abs(wide(0, 2) - wide(1, 2)) > 1e-3);
}

TEST_CASE("a periodic mesh must close, with one triangle on each side of each edge") {
  PeriodicMesh mesh = equilateral_triangles(1);
  mesh.triangles.pop_back();
  CHECK_THROWS_WITH(forced_rigidity(mesh), "oracle homogenised_bending: an edge has one triangle");
  mesh = equilateral_triangles(1);
  mesh.triangles.push_back(mesh.triangles[0]);
  CHECK_THROWS_WITH(relaxed_rigidity(mesh),
                    "oracle homogenised_bending: an edge has two triangles on one side");
  mesh = equilateral_triangles(1);
  for (auto& triangle : mesh.triangles) std::swap(triangle[0], triangle[1]);
  CHECK_THROWS_WITH(forced_rigidity(mesh),
                    "oracle homogenised_bending: a triangle has no area or is turned over");
  mesh = equilateral_triangles(1);
  mesh.period_b = Eigen::Vector2d(.5, 0);
  CHECK_THROWS_AS(forced_rigidity(mesh), InputError);
}

TEST_CASE("hinges with either triangle flat are refused") {
  PlaneSheet sheet;
  sheet.points.resize(2, 4);
  sheet.hinges = {{0, 1, 2, 3}};
  sheet.counted = {1};
  sheet.held = {1, 1, 1, 1};
  sheet.points << .4, .6, 0, 1, 0, -.5, 0, 0;
  CHECK_THROWS_AS(forced_cylinder_rigidity(sheet, .3), InputError);
  sheet.points << .4, .6, 0, 1, .7, 0, 0, 0;
  CHECK_THROWS_AS(forced_cylinder_rigidity(sheet, .3), InputError);
  sheet.points << .4, .6, 0, 1, .7, -.5, 0, 0;
  CHECK(forced_cylinder_rigidity(sheet, .3) > 0);
}

TEST_CASE("only counted hinges of a sheet weigh, each as its triangles' areas") {
  PlaneSheet sheet;
  sheet.points.resize(2, 5);
  sheet.points << .4, .6, 0, 1.1, 1.7, .8, -.5, 0, .2, .9;
  sheet.hinges = {{0, 1, 2, 3}, {2, 4, 3, 0}};
  sheet.counted = {1, 1};
  sheet.held = {1, 1, 1, 1, 1};
  const auto twice_area = [&](int a, int b, int c) {
    const Eigen::Vector2d u = sheet.points.col(b) - sheet.points.col(a),
                          w = sheet.points.col(c) - sheet.points.col(a);
    return std::abs(u.x() * w.y() - u.y() * w.x());
  };
  const double first_weight = twice_area(0, 2, 3) + twice_area(1, 2, 3),
               second_weight = twice_area(2, 3, 0) + twice_area(4, 3, 0), angle = .7;
  const double both = forced_cylinder_rigidity(sheet, angle);
  sheet.counted = {1, 0};
  const double first = forced_cylinder_rigidity(sheet, angle);
  sheet.counted = {0, 1};
  const double second = forced_cylinder_rigidity(sheet, angle);
  CHECK(std::abs(first - second) > 1e-3);
  CHECK(both ==
        Approx((first * first_weight + second * second_weight) / (first_weight + second_weight))
            .epsilon(1e-12));
}

// Every hinge: theta = (w1 + w2 - w3 - w4)/h, c = l/(2 h). A period has four slanting hinges and
// one of the middle row; the outer rows' edges have none. Bending, w = x^2/2: a slanting hinge
// turns by l^2/(2 h), wherever its rows are shifted; a shift makes the middle one flat. Twisting,
// w = x y/2: the slanting ones turn by l/2, the middle one does not.
TEST_CASE("a ribbon of two rows is as stiff as its three kinds of hinges") {
  const double edge = .7, h = edge * root3 / 2, c = edge / (2 * h);
  const RibbonRigidity two = equilateral_ribbon(edge, 2);
  CHECK(two.bending ==
        Approx(c / 2 * 4 * std::pow(edge * edge / (2 * h), 2) / edge).epsilon(1e-13));
  CHECK(two.twisting == Approx(4 * c / 2 * 4 * std::pow(edge / 2, 2) / edge).epsilon(1e-13));
}

TEST_CASE("ribbons scale with their edge, and grow by the sheet's own with each row pair") {
  CHECK_THROWS_WITH(equilateral_ribbon(1, 1),
                    "oracle homogenised_bending: a ribbon needs two rows");
  const RibbonRigidity one = equilateral_ribbon(1, 6), wide = equilateral_ribbon(2.3, 6);
  CHECK(wide.bending == Approx(2.3 * one.bending).epsilon(1e-11));
  CHECK(wide.twisting == Approx(2.3 * one.twisting).epsilon(1e-11));
  const Eigen::Matrix3d R = relaxed_rigidity(equilateral_triangles(1));
  const RibbonRigidity wider = equilateral_ribbon(1, 26);
  const double added = 20 * root3 / 2;
  CHECK((wider.bending - one.bending) / added == Approx(strip_rigidity(R, 0)).epsilon(1e-6));
  CHECK((wider.twisting - one.twisting) / added == Approx(4 * R(2, 2)).epsilon(1e-6));
}

TEST_CASE("points that are not held move to where the sheet bends least") {
  // a ribbon as a finite sheet: its free points take the least energy that any shift of one gives
  PlaneSheet sheet = ribbon_sheet(1, 2, 3);
  const auto v = [](int i, int j) { return j * 4 + i; };
  // the middle row's three edges, and slanting ones of both rows
  sheet.hinges = {{v(1, 2), v(1, 0), v(0, 1), v(1, 1)},
                  {v(2, 2), v(2, 0), v(1, 1), v(2, 1)},
                  {v(0, 1), v(2, 0), v(1, 0), v(1, 1)},
                  {v(1, 1), v(2, 2), v(2, 1), v(1, 2)}};
  for (auto& hinge : sheet.hinges) {  // corner 0 above the directed edge
    const Eigen::Vector2d e = sheet.points.col(hinge[3]) - sheet.points.col(hinge[2]),
                          a = sheet.points.col(hinge[0]) - sheet.points.col(hinge[2]);
    if (e.x() * a.y() - e.y() * a.x() < 0) std::swap(hinge[0], hinge[1]);
  }
  sheet.counted = {1, 1, 1, 1};
  sheet.held.assign(12, 1);
  const double angle = .5, held = relaxed_cylinder_rigidity(sheet, angle);
  CHECK(held == Approx(forced_cylinder_rigidity(sheet, angle)).epsilon(1e-14));
  sheet.held[std::size_t(v(1, 1))] = 0;
  const double one_free = relaxed_cylinder_rigidity(sheet, angle);
  sheet.held[std::size_t(v(2, 2))] = 0;
  const double two_free = relaxed_cylinder_rigidity(sheet, angle);
  CHECK(one_free < held * (1 - 1e-3));
  CHECK(two_free < one_free * (1 - 1e-3));
  CHECK(two_free >= 0);
  sheet.held.assign(12, 0);
  CHECK_THROWS_WITH(relaxed_cylinder_rigidity(sheet, angle),
                    "oracle homogenised_bending: too few points are held");
}
