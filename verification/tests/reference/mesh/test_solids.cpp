// Discs, cylinders, spheres, hinges, pleats: vertices, triangles and limits.
#include <Eigen/Geometry>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

#include "reference/mesh/shapes.h"

using namespace foldproof;

namespace {

void check_refused(const std::string& said, const std::function<void()>& act) {
  CHECK_THROWS_WITH(act(), Catch::StartsWith(said));
}

}  // namespace

TEST_CASE("a disc of two rings has the vertices of its rings in turn") {
  const TriangleMesh disc = make_disc(0.7, 2);
  PerParticle3 x = PerParticle3::Zero(3, 1 + 6 + 12);
  for (int i = 0; i < 12; ++i) {
    const Vector3 place(std::cos(i * pi / 6), std::sin(i * pi / 6), 0);
    x.col(7 + i) = 0.7 * place;
    if (i % 2 == 0) x.col(1 + i / 2) = 0.35 * place;
  }
  CHECK((disc.rest - x).cwiseAbs().maxCoeff() < 1e-15);
}

TEST_CASE("a cylinder has the vertices of its rings from below") {
  const TriangleMesh cylinder = make_cylinder(0.3, 1.1, 3, 2);
  REQUIRE(cylinder.particles() == 9);
  for (int v = 0; v < 9; ++v) {
    const double angle = v % 3 * 2 * pi / 3;
    const Vector3 place(0.3 * std::sin(angle), 0.55 * (v / 3), 0.3 * std::cos(angle));
    CHECK((cylinder.rest.col(v) - place).norm() < 1e-15);
  }
}

TEST_CASE("a divided triangle has its parts in the order described") {
  PerParticle3 x = PerParticle3::Zero(3, 3);
  x(0, 1) = x(1, 2) = 4;
  const TriangleMesh mesh = make_triangle_mesh(x, {{0, 1, 2}});
  const TriangleMesh fine = divide_edges(mesh, 4);
  PerParticle3 places = PerParticle3::Zero(3, 15);  // corners, edges 01, 02, 12, inside
  places.row(0) << 0, 4, 0, 1, 2, 3, 0, 0, 0, 3, 2, 1, 1, 2, 1;
  places.row(1) << 0, 0, 4, 0, 0, 0, 1, 2, 3, 1, 2, 3, 1, 1, 2;
  CHECK((fine.rest - places).cwiseAbs().maxCoeff() < 1e-15);
  // row by row: those like the triangle, then those that are turned
  const std::vector<Triangle> expected{{0, 3, 6},    {3, 4, 12},   {4, 5, 13},   {5, 1, 9},
                                       {6, 12, 7},   {12, 13, 14}, {13, 9, 10},  {7, 14, 8},
                                       {14, 10, 11}, {8, 11, 2},   {3, 12, 6},   {4, 13, 12},
                                       {5, 9, 13},   {12, 14, 7},  {13, 10, 14}, {14, 11, 8}};
  CHECK(fine.triangles == expected);
  CHECK(divide_edges(mesh, 1).triangles == mesh.triangles);
  CHECK_THROWS_WITH(divide_edges(mesh, 0), "divided: parts is 0; give 1 or more");
}

TEST_CASE("spheres are divided icosahedra whose vertices are carried out to the radius") {
  const auto check_carried = [](const TriangleMesh& sphere, TriangleMesh divided) {
    divided.rest.colwise().normalize();
    CHECK(sphere.triangles == divided.triangles);
    CHECK((sphere.rest - 0.7 * divided.rest).cwiseAbs().maxCoeff() < 1e-15);
  };
  const TriangleMesh twelve = make_icosphere(1, 0);
  check_carried(make_icosphere(0.7, 0), twelve);
  check_carried(make_icosphere(0.7, 2), divide_edges(make_icosphere(1, 1), 2));
  for (const int divisions : {1, 3, 4})
    check_carried(make_geodesic_sphere(0.7, divisions), divide_edges(twelve, divisions));
}

TEST_CASE("lengths of solids are positive and finite, counts within their limits") {
  for (const double bad : {0.0, -0.2, double(INFINITY), std::nan("")}) {
    check_refused("make_disc: radius is ", [&] { make_disc(bad, 2); });
    check_refused("make_cylinder: radius is ", [&] { make_cylinder(bad, 1, 3, 1); });
    check_refused("make_cylinder: height is ", [&] { make_cylinder(1, bad, 3, 1); });
    check_refused("make_icosphere: radius is ", [&] { make_icosphere(bad, 0); });
    check_refused("make_geodesic_sphere: radius is ", [&] { make_geodesic_sphere(bad, 1); });
    check_refused("make_hinge: length is ", [&] { make_hinge(bad, 1); });
    check_refused("make_statue: height is ", [&] { make_statue(bad, 3); });
    check_refused("make_even_statue: height is ", [&] { make_even_statue(bad, 15); });
  }
  for (const bool above : {false, true}) {
    check_refused("make_disc: rings is ", [&] { make_disc(1, above ? 10001 : 0); });
    check_refused("make_cylinder: around", [&] { make_cylinder(1, 1, above ? 10001 : 2, 1); });
    check_refused("make_cylinder: along", [&] { make_cylinder(1, 1, 3, above ? 10001 : 0); });
    check_refused("make_icosphere: subdiv", [&] { make_icosphere(1, above ? 10 : -1); });
    check_refused("make_geodesic_sphere: d", [&] { make_geodesic_sphere(1, above ? 513 : 0); });
    check_refused("make_statue: subdivisions is ", [&] { make_statue(1, above ? 9 : 2); });
  }
  // 31 is a prime, 62 and 93 are its multiples
  for (const int bad : {14, 257, 31, 62, 93, -15})
    check_refused("make_even_statue: divisions is ", [&] { make_even_statue(1, bad); });
  CHECK(make_even_statue(0.9, 15).triangles.size() == 20 * 15 * 15);
}

TEST_CASE("a hinge's particles are where they are drawn, for angles between -pi and pi") {
  PerParticle3 x(3, 4);
  x << 0.2, 0.35, 0, 0.5, 0.45, -0.3 * std::cos(3.1), 0, 0, 0, -0.3 * std::sin(3.1), 0, 0;
  CHECK((make_hinge(0.5, 3.1).rest - x).cwiseAbs().maxCoeff() < 1e-15);
  for (const double bad : {pi, -pi, std::nan("")})
    check_refused("make_hinge: angle is ", [&] { make_hinge(1, bad); });
}

TEST_CASE("panels of a pleated sheet rise and fall in turn, the last one narrower") {
  // columns at 0, 1, 3, 7, 15, 31; folds at 3 and 15
  const TriangleMesh sheet = make_sheet({SheetPattern::union_jack, 31, 0.9, 5, 2, 0, 0, 16});
  const auto pleated = [&](int columns_per_pleat, const std::array<double, 6>& up) {
    PerParticle3 x = sheet.rest;
    x.row(0) *= std::cos(0.35);
    for (int v = 0; v < sheet.particles(); ++v) x(2, v) = std::sin(0.35) * up[size_t(v % 6)];
    CHECK((pleated_positions(sheet, columns_per_pleat, 0.7) - x).cwiseAbs().maxCoeff() < 1e-13);
  };
  pleated(2, {0, 1, 3, -1, -9, 7});
  pleated(1000000, {0, 1, 3, 7, 15, 31});
  check_refused("pleated: columns_per_pleat is 0", [&] { pleated_positions(sheet, 0, 0.7); });
  check_refused("pleated: angle is 3.14", [&] { pleated_positions(sheet, 2, pi); });
}

TEST_CASE(
    "a sheet is pleated only if it is flat, and no triangle crosses a fold or leaves the grid") {
  TriangleMesh sheet = make_sheet({SheetPattern::one_diagonal, 4, 3, 4, 3});
  sheet.rest(2, sheet.particles() - 1) = 1e-300;
  check_refused("pleated: the sheet is empty", [&] { pleated_positions(sheet, 1, 1); });
  check_refused("pleated: the sheet is empty", [] { pleated_positions({}, 1, 1); });
  // the first row's columns are at 0, 1, 2; the second row's points at these x
  const auto pleat = [](double left, double right, int columns) {
    PerParticle3 x = PerParticle3::Zero(3, 5);
    x.topRows<2>() << 0, 1, 2, left, right, 0, 0, 0, 1, 1;
    pleated_positions(make_triangle_mesh(x, {{1, 2, 4}, {0, 1, 3}, {1, 4, 3}}), columns, 1);
  };
  CHECK_NOTHROW(pleat(0, 2, 2));
  check_refused("pleated: triangle 2 crosses a fold line", [&] { pleat(0, 2, 1); });
  check_refused("pleated: triangle 1 crosses a fold line", [&] { pleat(-0.25, 2, 2); });
  check_refused("pleated: triangle 0 crosses a fold line", [&] { pleat(0, 2.25, 2); });
}
