// Discs, cylinders, spheres, hinges, pleats: vertices, triangles and limits.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <array>
#include <limits>
#include <sstream>

#include "reference/mesh/shapes.h"

using namespace foldproof;

namespace {

const double infinity = std::numeric_limits<double>::infinity();

template <class Action>
std::string refusal_of(const Action& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "not refused";
}

}  // namespace

TEST_CASE("a disc of two rings has the vertices and triangles drawn by hand") {
  const TriangleMesh disc = make_disc(0.7, 2);
  REQUIRE(disc.particles() == 1 + 6 + 12);
  CHECK(disc.rest.col(0) == Vector3::Zero());
  for (int i = 0; i < 6; ++i) {
    const double angle = i * pi / 3;
    CHECK((disc.rest.col(1 + i) - 0.35 * Vector3(std::cos(angle), std::sin(angle), 0)).norm() <
          1e-15);
  }
  for (int i = 0; i < 12; ++i) {
    const double angle = i * pi / 6;
    CHECK((disc.rest.col(7 + i) - 0.7 * Vector3(std::cos(angle), std::sin(angle), 0)).norm() <
          1e-15);
  }
  std::vector<Triangle> expected;
  for (int i = 0; i < 6; ++i) expected.push_back({0, 1 + i, 1 + (i + 1) % 6});
  for (int i = 0; i < 6; ++i) {
    const int inner = 1 + i, next = 1 + (i + 1) % 6, outer = 7 + 2 * i;
    expected.push_back({inner, outer, outer + 1});
    expected.push_back({inner, outer + 1, next});
    expected.push_back({next, outer + 1, 7 + (2 * i + 2) % 12});
  }
  CHECK(disc.triangles == expected);
  CHECK(make_disc(0.7, 4).triangles.size() == 6 * 16);
}

TEST_CASE("a cylinder of three by two rectangles has the vertices and triangles drawn by hand") {
  const TriangleMesh cylinder = make_cylinder(0.3, 1.1, 3, 2);
  REQUIRE(cylinder.particles() == 9);
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) {
      const double angle = i * 2 * pi / 3;
      CHECK((cylinder.rest.col(3 * j + i) -
             Vector3(0.3 * std::sin(angle), 0.55 * j, 0.3 * std::cos(angle)))
                .norm() < 1e-15);
    }
  CHECK(cylinder.triangles == std::vector<Triangle>{{0, 1, 4},
                                                    {0, 4, 3},
                                                    {1, 2, 5},
                                                    {1, 5, 4},
                                                    {2, 0, 3},
                                                    {2, 3, 5},
                                                    {3, 4, 7},
                                                    {3, 7, 6},
                                                    {4, 5, 8},
                                                    {4, 8, 7},
                                                    {5, 3, 6},
                                                    {5, 6, 8}});
}

TEST_CASE("an icosahedron has twelve vertices at its radius and thirty equal edges") {
  const TriangleMesh mesh = make_icosphere(0.7, 0);
  REQUIRE(mesh.particles() == 12);
  REQUIRE(mesh.edges.size() == 30);
  const double edge = 4 * 0.7 / std::sqrt(10 + 2 * std::sqrt(5.0));
  const Eigen::VectorXd lengths = rest_lengths(mesh);
  CHECK((lengths.array() - edge).abs().maxCoeff() < 1e-15);
  CHECK((mesh.rest.colwise().norm().array() - 0.7).abs().maxCoeff() < 1e-15);
  for (const Triangle& t : mesh.triangles) {
    const Vector3 a = mesh.rest.col(t[0]), b = mesh.rest.col(t[1]), c = mesh.rest.col(t[2]);
    CHECK((b - a).cross(c - a).dot(a) > 0.01);
  }
}

TEST_CASE("divided triangles lie where their parts of the corners say, in the order described") {
  const TriangleMesh mesh = make_hinge(0.7, 0.4);
  for (const int parts : {1, 2, 3, 5}) {
    INFO(parts);
    const TriangleMesh fine = divide_edges(mesh, parts);
    const int of_edges = 5 * (parts - 1), inside = (parts - 1) * (parts - 2) / 2;
    REQUIRE(fine.particles() == 4 + of_edges + 2 * inside);
    CHECK(fine.rest.leftCols(4) == mesh.rest);
    for (int e = 0; e < 5; ++e)
      for (int k = 1; k < parts; ++k) {
        const Edge& edge = mesh.edges[size_t(e)];
        const Vector3 a = mesh.rest.col(edge.a), b = mesh.rest.col(edge.b);
        CHECK((fine.rest.col(4 + e * (parts - 1) + k - 1) - (a + (b - a) * k / parts)).norm() <
              1e-15);
      }
    std::vector<std::array<Vector3, 3>> expected;
    int v = 4 + of_edges;
    for (const auto& [a, b, c] : mesh.triangles) {
      const auto point = [&, a = a, b = b, c = c](int i, int j) {
        return Vector3(
            (mesh.rest.col(a) * (parts - i - j) + mesh.rest.col(b) * i + mesh.rest.col(c) * j) /
            parts);
      };
      for (int j = 1; j < parts; ++j)
        for (int i = 1; i < parts - j; ++i)
          CHECK((fine.rest.col(v++) - point(i, j)).norm() < 1e-15);
      for (int j = 0; j < parts; ++j)
        for (int i = 0; i < parts - j; ++i)
          expected.push_back({point(i, j), point(i + 1, j), point(i, j + 1)});
      for (int j = 0; j < parts - 1; ++j)
        for (int i = 0; i < parts - 1 - j; ++i)
          expected.push_back({point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)});
    }
    REQUIRE(fine.triangles.size() == expected.size());
    for (size_t t = 0; t < expected.size(); ++t)
      for (size_t k = 0; k < 3; ++k)
        CHECK((fine.rest.col(fine.triangles[t][k]) - expected[t][k]).norm() < 1e-15);
  }
  CHECK(divide_edges(mesh, 1).triangles == mesh.triangles);
  CHECK(refusal_of([&] { divide_edges(mesh, 0); }) == "divided: parts is 0; give 1 or more");
}

TEST_CASE("spheres are divided icosahedra whose vertices are carried out to the radius") {
  TriangleMesh halved = make_icosphere(1, 0);
  for (int level = 1; level <= 2; ++level) {
    halved = divide_edges(halved, 2);
    halved.rest.colwise().normalize();
    const TriangleMesh sphere = make_icosphere(0.7, level);
    CHECK(sphere.triangles == halved.triangles);
    CHECK((sphere.rest - 0.7 * halved.rest).cwiseAbs().maxCoeff() < 1e-15);
  }
  for (const int divisions : {1, 3, 4}) {
    TriangleMesh divided = divide_edges(make_icosphere(1, 0), divisions);
    divided.rest.colwise().normalize();
    const TriangleMesh sphere = make_geodesic_sphere(0.7, divisions);
    CHECK(sphere.particles() == 10 * divisions * divisions + 2);
    CHECK(sphere.triangles == divided.triangles);
    CHECK((sphere.rest - 0.7 * divided.rest).cwiseAbs().maxCoeff() < 1e-15);
  }
}

TEST_CASE("lengths of solids are positive and finite, counts within their limits") {
  const std::string length = "; give a positive length in m";
  for (const double bad : {0.0, -0.2, infinity, std::nan("")}) {
    std::ostringstream text;
    text << " is " << bad << length;
    const std::string is_bad = text.str();
    CHECK(refusal_of([&] { make_disc(bad, 2); }) == "make_disc: radius" + is_bad);
    CHECK(refusal_of([&] { make_cylinder(bad, 1, 3, 1); }) == "make_cylinder: radius" + is_bad);
    CHECK(refusal_of([&] { make_cylinder(1, bad, 3, 1); }) == "make_cylinder: height" + is_bad);
    CHECK(refusal_of([&] { make_icosphere(bad, 0); }) == "make_icosphere: radius" + is_bad);
    CHECK(refusal_of([&] { make_geodesic_sphere(bad, 1); }) ==
          "make_geodesic_sphere: radius" + is_bad);
    CHECK(refusal_of([&] { make_hinge(bad, 1); }) == "make_hinge: length" + is_bad);
    CHECK(refusal_of([&] { make_statue(bad, 3); }) == "make_statue: height" + is_bad);
    CHECK(refusal_of([&] { make_even_statue(bad, 15); }) == "make_even_statue: height" + is_bad);
  }
  CHECK(make_disc(1e-9, 1).triangles.size() == 6);
  CHECK(make_cylinder(1e-9, 1e-9, 3, 1).triangles.size() == 6);
  CHECK(make_geodesic_sphere(1e-9, 1).triangles.size() == 20);
  for (const int bad : {0, 10001}) {
    const std::string is_bad = " is " + std::to_string(bad);
    CHECK(refusal_of([&] { make_disc(1, bad); }) ==
          "make_disc: rings" + is_bad + "; give 1 to 10000");
    CHECK(refusal_of([&] { make_cylinder(1, 1, 3, bad); }) ==
          "make_cylinder: along" + is_bad + "; give 1 to 10000");
  }
  for (const int bad : {2, 10001})
    CHECK(refusal_of([&] { make_cylinder(1, 1, bad, 1); }) ==
          "make_cylinder: around is " + std::to_string(bad) + "; give 3 to 10000");
  for (const int bad : {-1, 10})
    CHECK(refusal_of([&] { make_icosphere(1, bad); }) ==
          "make_icosphere: subdivisions is " + std::to_string(bad) + "; give 0 to 9");
  for (const int bad : {0, 513})
    CHECK(refusal_of([&] { make_geodesic_sphere(1, bad); }) ==
          "make_geodesic_sphere: divisions is " + std::to_string(bad) + "; give 1 to 512");
  for (const int bad : {2, 9})
    CHECK(refusal_of([&] { make_statue(1, bad); }) ==
          "make_statue: subdivisions is " + std::to_string(bad) + "; give 3 to 8");
  // 31 is a prime, 62 and 93 are its multiples
  for (const int bad : {14, 257, 31, 62, 93, -15})
    CHECK(refusal_of([&] { make_even_statue(1, bad); }) ==
          "make_even_statue: divisions is " + std::to_string(bad) +
              "; give 15 to 256, with a divisor from 15 to 29");
}

TEST_CASE("a hinge's particles are where they are drawn, for angles between -pi and pi") {
  const PerParticle3 x = make_hinge(0.5, 0.3).rest;
  CHECK((x.col(0) - Vector3(0.2, 0.45, 0)).norm() < 1e-16);
  CHECK((x.col(1) - Vector3(0.35, -0.3 * std::cos(0.3), -0.3 * std::sin(0.3))).norm() < 1e-16);
  CHECK(x.col(2) == Vector3::Zero());
  CHECK(x.col(3) == Vector3(0.5, 0, 0));
  CHECK(make_hinge(0.5, 0.3).triangles == std::vector<Triangle>{{0, 2, 3}, {1, 3, 2}});
  for (const double angle : {pi, -pi, 4.0, std::nan("")})
    CHECK(refusal_of([&] {
            make_hinge(1, angle);
          }).ends_with("; give an angle between -pi and pi rad"));
  CHECK(refusal_of([] { make_hinge(1, pi); }) ==
        "make_hinge: angle is 3.14159; give an angle between -pi and pi rad");
  for (const double angle : {3.1, -3.1})
    CHECK(refusal_of([&] { make_hinge(1, angle); }) == "not refused");
}

TEST_CASE("panels of a pleated sheet rise and fall in turn, the last one narrower") {
  // columns at 0, 1, 3, 7, 15, 31; folds at 3 and 15
  const TriangleMesh sheet = make_sheet({SheetPattern::union_jack, 31, 0.9, 5, 2, 0, 0, 16});
  const double c = std::cos(0.35), s = std::sin(0.35);
  const PerParticle3 x = pleated_positions(sheet, 2, 0.7);
  const std::array<double, 6> along{0, 1, 3, 7, 15, 31}, up{0, 1, 3, -1, -9, 7};
  for (int v = 0; v < sheet.particles(); ++v) {
    const size_t column = size_t(v % 6);
    const Vector3 expected(c * along[column], sheet.rest(1, v), s * up[column]);
    CHECK((x.col(v) - expected).norm() < 1e-13);
  }
  const PerParticle3 one_panel = pleated_positions(sheet, 1000000, -0.7);
  CHECK((one_panel.row(2) + s * sheet.rest.row(0)).cwiseAbs().maxCoeff() < 1e-13);
  CHECK((one_panel.row(0) - c * sheet.rest.row(0)).cwiseAbs().maxCoeff() < 1e-13);
  const PerParticle3 all_folds = pleated_positions(sheet, 1, 0.7);
  CHECK(all_folds(2, 1) == Approx(s));
  CHECK(all_folds(2, 2) == Approx(-s));
  CHECK(all_folds(2, 5) == Approx(s * (1 - 2 + 4 - 8 + 16)));
  CHECK(refusal_of([&] { pleated_positions(sheet, 0, 0.7); }) ==
        "pleated: columns_per_pleat is 0; give 1 to 1000000");
  CHECK(refusal_of([&] { pleated_positions(sheet, 1000001, 0.7); }).ends_with("1 to 1000000"));
  CHECK(refusal_of([&] { pleated_positions(sheet, 2, pi); }) ==
        "pleated: angle is 3.14159; give an angle between -pi and pi rad");
}

TEST_CASE(
    "a sheet is pleated only if it is flat, and no triangle crosses a fold or leaves the grid") {
  const std::string not_flat =
      "pleated: the sheet is empty or leaves the plane z = 0; give one from make_sheet";
  CHECK(refusal_of([] { pleated_positions({PerParticle3(3, 0), {}, {}, {}}, 1, 1); }) == not_flat);
  TriangleMesh sheet = make_sheet({SheetPattern::one_diagonal, 4, 3, 4, 3});
  sheet.rest(2, sheet.particles() - 1) = 1e-300;
  CHECK(refusal_of([&] { pleated_positions(sheet, 1, 1); }) == not_flat);
  const auto crossing = [](const TriangleMesh& mesh, int columns) {
    return refusal_of([&] { pleated_positions(mesh, columns, 1); });
  };
  const auto said = [](int t) {
    return "pleated: triangle " + std::to_string(t) +
           " crosses a fold line; give a sheet whose triangles keep to grid columns (one_diagonal, "
           "alternating, union_jack, criss_cross)";
  };
  // the first row's columns are at 0, 1, 2
  PerParticle3 x(3, 5);
  x << 0, 1, 2, 0, 2, 0, 0, 0, 1, 1, 0, 0, 0, 0, 0;
  const auto mesh_of = [&](const std::vector<Triangle>& triangles) {
    return make_triangle_mesh(x, triangles);
  };
  CHECK(crossing(mesh_of({{0, 1, 3}, {1, 4, 3}, {1, 2, 4}}), 2) == "not refused");
  CHECK(crossing(mesh_of({{0, 1, 3}, {1, 4, 3}, {1, 2, 4}}), 1) == said(1));
  CHECK(crossing(mesh_of({{1, 4, 3}, {0, 1, 3}, {1, 2, 4}}), 1) == said(0));
  x(0, 3) = -0.25;  // left of the first column
  CHECK(crossing(mesh_of({{1, 2, 4}, {0, 1, 3}, {1, 4, 3}}), 2) == said(1));
  x(0, 3) = 0, x(0, 4) = 2.25;  // right of the last
  CHECK(crossing(mesh_of({{0, 1, 3}, {1, 2, 4}, {1, 4, 3}}), 2) == said(1));
}

TEST_CASE("an even statue of fifteen divisions, the fewest, stands on the ground at its height") {
  const TriangleMesh statue = make_even_statue(0.9, 15);
  CHECK(statue.triangles.size() == 20 * 15 * 15);
  CHECK(euler_characteristic(statue) == 2);
  CHECK(statue.rest.row(1).minCoeff() == 0);
  CHECK(statue.rest.row(1).maxCoeff() == Approx(0.9));
}
