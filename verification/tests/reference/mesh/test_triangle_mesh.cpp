// Meshes worked out by hand: edges, hinges, areas; nearest points and intersections.
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "reference/bodies/ray_parity.h"
#include "reference/mesh/nearest_point.h"
#include "reference/mesh/self_intersection.h"
#include "reference/mesh/shapes.h"
#include "reference/mesh/triangle_mesh.h"

using namespace foldproof;

using Catch::Matchers::Contains;

namespace {

/// Places in general position.
PerParticle3 places(int count) {
  PerParticle3 x(3, count);
  for (int v = 0; v < count; ++v)
    x.col(v) << 0.7 * std::sin(3.0 * v), 1.3 * std::cos(5.0 * v + 1), 0.4 * std::sin(7.0 * v + 2);
  return x;
}

std::string refusal_of(const PerParticle3& x, const std::vector<Triangle>& triangles,
                       const MeshOrigin& origin = {}) {
  try {
    make_triangle_mesh(x, triangles, origin);
  } catch (const InputError& error) {
    return error.what();
  }
  return "not refused";
}

}  // namespace

TEST_CASE("edges and hinges of five triangles are those listed by hand") {
  //   4 --- 3 --- 5       a strip; the triangle (6, 5, 2) hangs on its end
  //    \   / \   / \.
  //     0 --- 2 --- 6
  const TriangleMesh mesh =
      make_triangle_mesh(places(7), {{2, 3, 0}, {5, 2, 6}, {4, 0, 3}, {3, 2, 5}, {1, 6, 2}});
  // the triangle that runs from the smaller particle of the edge to the larger comes first
  const std::vector<std::array<int, 4>> edges{
      {0, 2, 0, -1}, {0, 3, 2, 0}, {0, 4, 2, -1}, {1, 2, 4, -1}, {1, 6, 4, -1}, {2, 3, 0, 3},
      {2, 5, 3, 1},  {2, 6, 1, 4}, {3, 4, 2, -1}, {3, 5, 3, -1}, {5, 6, 1, -1}};
  std::vector<std::array<int, 4>> found;
  for (const auto& [a, b, of] : mesh.edges) found.push_back({a, b, of[0], of[1]});
  CHECK(found == edges);
  std::vector<std::array<int, 5>> hinges;
  for (const auto& [x, edge] : mesh.hinges) hinges.push_back({x[0], x[1], x[2], x[3], edge});
  CHECK(hinges == std::vector<std::array<int, 5>>{
                      {4, 2, 0, 3, 1}, {0, 5, 2, 3, 5}, {3, 6, 2, 5, 6}, {5, 1, 2, 6, 7}});
  CHECK(euler_characteristic(mesh) == 7 - 11 + 5);
}

TEST_CASE("edges of three triangles and of opposite ones are refused with each triangle") {
  const PerParticle3 x = places(6);
  CHECK(refusal_of(x, {{5, 4, 3}, {2, 1, 0}, {1, 2, 3}, {4, 2, 1}, {1, 2, 5}})
            .starts_with("mesh: triangle 3: the edge between vertex 1 and vertex 2 has three "
                         "triangles or more (triangle 1, triangle 2 and this one)"));
  CHECK_THAT(refusal_of(x, {{5, 4, 3}, {0, 2, 1}, {2, 1, 3}, {5, 3, 1}}),
             Contains("mesh: triangle 2: opposite orientation to its neighbour, triangle 1: both "
                      "run along the edge between vertex 1 and vertex 2"));
  CHECK_THAT(refusal_of(x, {{0, 1, 2}, {3, 1, 2}, {5, 4, 3}}),
             Contains("mesh: triangle 1: opposite orientation to its neighbour, triangle 0"));
}

TEST_CASE("a triangle has area if it exceeds 1e-12 of its longest side squared") {
  // the height over the longest side, which has the length 5 times the size, must exceed 2e-12 * 5
  const Vector3 along = Vector3(3, 4, 0) / 5, up(0, 0, 1);
  for (const double size : {1e-160, 1.0, 1e140})
    for (long first = 0; first < 3; ++first)
      for (const double height : {2.1e-12, 1.9e-12}) {
        std::array<Vector3, 3> t{Vector3::Zero(), along, 0.4 * along + height * up};
        std::rotate(t.begin(), t.begin() + first, t.end());
        PerParticle3 x(3, 3);
        x << t[0], t[1], t[2];
        CHECK((refusal_of(5 * size * x, {{0, 1, 2}}) == "not refused") == (height > 2e-12));
      }
}

namespace {

double volume(const TriangleMesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    sum += Vector3(mesh.rest.col(a)).cross(Vector3(mesh.rest.col(b))).dot(mesh.rest.col(c)) / 6;
  return sum;
}

/// On its base, of the height 1.7 m, and nowhere through itself.
void check_stands(const TriangleMesh& statue) {
  CHECK(statue.rest.row(1).minCoeff() == 0);
  CHECK(std::abs(statue.rest.row(1).maxCoeff() - 1.7) < 4 * std::numeric_limits<double>::epsilon());
  CHECK(self_intersections(statue.rest, statue.triangles).empty());
}

}  // namespace

TEST_CASE("mesh: the even statue is clean, too, and its smallest triangle is larger") {
  const TriangleMesh even = make_even_statue(1.7, 32), plain = make_statue(1.7, 5);
  REQUIRE(even.triangles.size() == plain.triangles.size());
  const double of_even = triangle_areas(even.triangles, even.rest).minCoeff();
  CHECK(of_even > 1.5 * triangle_areas(plain.triangles, plain.rest).minCoeff());
  CHECK(volume(even) == Approx(volume(plain)).epsilon(0.01));
  check_stands(even);
  check_stands(plain);
  CHECK_THROWS_WITH(make_even_statue(1.7, 14), Catch::Contains("give 15 to 256"));
}

TEST_CASE("rays through edges and corners cross one triangle, on the lower sides of a cube") {
  // corners at nodes 1 and 4 of every row, or a hair above 4; each face of two triangles
  const double above = GENERATE(0.0, 5e-7);
  PerParticle3 x(3, 8);
  for (int k = 0; k < 8; ++k)
    x.col(k) = 0.5 * Vector3(k & 1 ? 4 + above : 1, k & 2 ? 4 + above : 1, k & 4 ? 4 + above : 1);
  const std::vector<Triangle> cube{{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6},
                                   {0, 1, 4}, {1, 5, 4}, {2, 6, 3}, {3, 6, 7},
                                   {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  const Lattice lattice{Vector3::Zero(), 0.5, {6, 7, 8}};
  const std::vector<std::uint8_t> votes = ray_parity(x, cube, lattice);
  for (long index = 0; index < lattice.size(); ++index) {
    const Node n = lattice.node(index);
    int expected = 0;
    for (size_t axis = 0; axis < 3; ++axis) {
      const auto crosses = [&](size_t across) { return 1 <= n[across] && n[across] < 4 + above; };
      expected += 1 < n[axis] && n[axis] <= 4 && crosses((axis + 1) % 3) && crosses((axis + 2) % 3);
    }
    CHECK(int(votes[size_t(index)]) == expected);
  }
}

TEST_CASE("triangles of one plane intersect where only their edges cross") {
  PerParticle3 x(3, 6);
  x << 0, 4, 2, 0, 4, 2, 0, 0, 3, 2, 2, -1, 0, 0, 0, 0, 0, 0;
  const std::vector<Triangle> star{{0, 1, 2}, {3, 4, 5}};
  CHECK(self_intersections(x, star).size() == 1);
  x.rightCols(3).row(0).array() += 4.5;
  CHECK(self_intersections(x, star).empty());
}

TEST_CASE("triangles that overlap in a plane are counted, and neighbours are none") {
  Sheet sheet{SheetPattern::jittered, 1.1, 0, 11, 7};
  sheet.jitter = 0.3;
  const TriangleMesh alone = make_sheet(sheet);
  // two squares of two triangles, half a side apart: three of the four pairs overlap
  PerParticle3 two(3, 8);
  two << 0, 1, 1, 0, 0.5, 1.5, 1.5, 0.5, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0;
  const std::vector<Triangle> halves{{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}};
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Vector3(1, 2, 3).normalized()).matrix();
  const auto count = [&](const PerParticle3& x, const std::vector<Triangle>& triangles) {
    return overlaps_in_plane(turn * x, triangles, turn.col(0), turn.col(1), 1e-9);
  };
  CHECK(count(alone.rest, alone.triangles) == 0);
  PerParticle3 apart(3, 6);  // only the long side of the second parts these two
  apart << 0, 4, 2, 4.545, 3.849, 4.49, 0, 0, 3.5, 1.935, -2.005, -0.087, 0, 0, 0, 0, 0, 0;
  CHECK(count(apart, {{0, 1, 2}, {3, 4, 5}}) == 0);
  CHECK(count(apart, {{3, 4, 5}, {0, 1, 2}}) == 0);
  CHECK(count(two, halves) == 3);
  two.rightCols(4).row(0).array() += 0.5;  // now they share a side
  CHECK(count(two, halves) == 0);
}
