// Edges, hinges, fans, areas and masses of triangle meshes, and what is refused.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "reference/mesh/triangle_mesh.h"

using namespace foldproof;
using Catch::Matchers::Contains;

namespace {

const double infinity = std::numeric_limits<double>::infinity();

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

TEST_CASE("areas, heights, masses and lengths of two triangles are those worked out by hand") {
  // right triangles of the sides 3, 4, 5 and 5, 12, 13 share the side 5
  PerParticle3 x(3, 4);
  x << 1, 4, 1, 4,  //
      2, 2, 6, 2,   //
      7, 7, 7, 19;
  const TriangleMesh mesh = make_triangle_mesh(x, {{0, 1, 2}, {3, 2, 1}});
  CHECK(triangle_areas(mesh.triangles, x).isApprox(Eigen::Vector2d(6, 30), 1e-15));
  CHECK(lumped_masses(mesh, 0.7).isApprox(0.7 * Eigen::Vector4d(2, 12, 12, 10), 1e-14));
  for (const double density : {0.0, infinity, std::nan("")})
    CHECK_THROWS_WITH(lumped_masses(mesh, density), Contains("lumped_masses: density is "));
  Eigen::VectorXd lengths(5), areas(5);  // of the edges 01, 02, 12, 13, 23
  lengths << 3, 4, 5, 12, 13;
  areas << 6, 6, 36, 30, 30;
  CHECK(rest_lengths(mesh).isApprox(lengths, 1e-15));
  CHECK(edge_areas(mesh).isApprox(areas, 1e-15));
  CHECK(smallest_height(mesh.triangles, x) == Approx(12.0 / 5).epsilon(1e-15));
  for (const Triangle& turned : {Triangle{3, 2, 1}, {2, 1, 3}, {1, 3, 2}})
    CHECK(smallest_height({turned, {3, 2, 1}}, x) == Approx(60.0 / 13).epsilon(1e-15));
  CHECK(smallest_height({}, x) == infinity);
}
