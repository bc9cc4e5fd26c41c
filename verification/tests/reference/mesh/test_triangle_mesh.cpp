// Edges, hinges, fans and refusals of triangle meshes; how messages name their parts.
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "reference/mesh/mesh_locations.h"
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

/// The first corner of each corner's fan, joined over shared edges again and again until
/// nothing changes.
std::vector<int> fans_by_joining(const std::vector<Triangle>& triangles) {
  std::vector<int> fan(3 * triangles.size());
  for (size_t i = 0; i < fan.size(); ++i) fan[i] = int(i);
  const auto corner = [&](size_t i) { return triangles[i / 3][i % 3]; };
  for (bool changes = true; changes;) {
    changes = false;
    for (size_t i = 0; i < fan.size(); ++i)
      for (size_t j = 0; j < fan.size(); ++j) {
        if (corner(i) != corner(j) || fan[i] <= fan[j]) continue;
        const size_t of_i = i % 3, of_j = j % 3;
        bool is_shared = false;
        for (size_t k : {1u, 2u})
          for (size_t l : {1u, 2u})
            is_shared |= triangles[i / 3][(of_i + k) % 3] == triangles[j / 3][(of_j + l) % 3];
        if (is_shared) fan[i] = fan[j], changes = true;
      }
  }
  return fan;
}

}  // namespace

TEST_CASE("edges and hinges of five triangles are those listed by hand") {
  //   4 --- 3 --- 5       a strip; the triangle (6, 5, 2) hangs on its end
  //    \   / \   / \.
  //     0 --- 2 --- 6
  const TriangleMesh mesh =
      make_triangle_mesh(places(7), {{2, 3, 0}, {5, 2, 6}, {4, 0, 3}, {3, 2, 5}, {1, 6, 2}});
  const std::vector<std::array<int, 4>> edges{
      {0, 2, 0, -1}, {0, 3, 0, 2}, {0, 4, 2, -1}, {1, 2, 4, -1}, {1, 6, 4, -1}, {2, 3, 0, 3},
      {2, 5, 3, 1},  {2, 6, 1, 4}, {3, 4, 2, -1}, {3, 5, 3, -1}, {5, 6, 1, -1}};
  REQUIRE(mesh.edges.size() == edges.size());
  for (size_t e = 0; e < edges.size(); ++e) {
    INFO(e);
    CHECK(mesh.edges[e].a == edges[e][0]);
    CHECK(mesh.edges[e].b == edges[e][1]);
    CHECK(std::minmax({mesh.edges[e].triangles[0], mesh.edges[e].triangles[1]}) ==
          std::minmax({edges[e][2], edges[e][3]}));
    if (edges[e][3] == -1) CHECK(mesh.edges[e].triangles[1] == -1);
  }
  // the triangle of x1 runs from the smaller particle of the edge to the larger
  const std::vector<std::array<int, 5>> hinges{
      {4, 2, 0, 3, 1}, {0, 5, 2, 3, 5}, {3, 6, 2, 5, 6}, {5, 1, 2, 6, 7}};
  REQUIRE(mesh.hinges.size() == hinges.size());
  for (size_t h = 0; h < hinges.size(); ++h) {
    INFO(h);
    const auto& p = mesh.hinges[h].particles;
    CHECK(std::array<int, 5>{p[0], p[1], p[2], p[3], mesh.hinges[h].edge} == hinges[h]);
    CHECK(std::ranges::count(mesh.triangles[size_t(mesh.edges[size_t(hinges[h][4])].triangles[0])],
                             p[0]) == 1);
  }
  CHECK(mesh.particles() == 7);
  CHECK(euler_characteristic(mesh) == 7 - 11 + 5);
}

TEST_CASE("fans are those found by joining corners over shared edges") {
  const std::vector<std::vector<Triangle>> meshes{
      // at 0: two triangles joined, apart, and a closed fan of three
      {{0, 1, 2}, {3, 0, 4}, {6, 0, 5}, {0, 2, 9}, {0, 6, 7}, {0, 7, 5}},
      // in an order in which fans grow together late
      {{0, 1, 2}, {0, 3, 4}, {0, 5, 6}, {0, 6, 1}, {0, 4, 5}, {0, 2, 3}, {8, 7, 2}},
      {{4, 3, 0}, {2, 1, 0}, {3, 2, 0}, {5, 6, 0}, {6, 7, 0}, {7, 8, 0}, {8, 5, 0}}};
  for (const std::vector<Triangle>& triangles : meshes) {
    int last = 0;
    for (const Triangle& t : triangles) last = std::max({last, t[0], t[1], t[2]});
    std::vector<Triangle> used = triangles;
    std::vector<char> is_used(size_t(last + 1), 0);
    for (const Triangle& t : triangles)
      for (const int v : t) is_used[size_t(v)] = 1;
    std::vector<int> unused;
    for (int v = 0; v <= last; ++v)
      if (!is_used[size_t(v)]) unused.push_back(v);
    for (size_t k = 0; k < unused.size(); ++k) {
      used.push_back({unused[k], last + 1 + 2 * int(k), last + 2 + 2 * int(k)});
    }
    const PerParticle3 x = places(last + 1 + 2 * int(unused.size()));
    CHECK(fans_of(make_mesh_of_fans(x, used)) == fans_by_joining(used));
  }
}

TEST_CASE("a vertex of two fans is refused with the first triangle of each") {
  const PerParticle3 x = places(7);
  CHECK(
      refusal_of(x, {{3, 1, 2}, {3, 2, 0}, {6, 3, 5}, {4, 3, 6}})
          .starts_with("mesh: vertex 3: its triangles form more than one fan (triangle 0 and "
                       "triangle 2 meet in this vertex only); give each fan a vertex of its own"));
  MeshOrigin origin{"fans.obj", {2, 3, 5, 7, 11, 13, 17}, {19, 23, 29, 31}};
  CHECK(refusal_of(x, {{3, 1, 2}, {3, 2, 0}, {4, 5, 3}, {6, 4, 3}}, origin)
            .starts_with("fans.obj:7: its triangles form more than one fan (the face of line 19 "
                         "and the face of line 29 meet"));
  CHECK(make_mesh_of_fans(x, {{3, 1, 2}, {3, 2, 0}, {6, 3, 5}, {4, 3, 6}}).hinges.size() == 2);
}

TEST_CASE("edges of three triangles and of opposite ones are refused with each triangle") {
  const PerParticle3 x = places(6);
  CHECK(refusal_of(x, {{5, 4, 3}, {2, 1, 0}, {1, 2, 3}, {4, 2, 1}, {1, 2, 5}})
            .starts_with("mesh: triangle 3: the edge between vertex 1 and vertex 2 has three "
                         "triangles or more (triangle 1, triangle 2 and this one)"));
  CHECK(refusal_of(x, {{5, 4, 3}, {0, 2, 1}, {2, 1, 3}, {5, 3, 1}}) ==
        "mesh: triangle 2: opposite orientation to its neighbour, triangle 1: both run along the "
        "edge between vertex 1 and vertex 2 the same way; reverse the order of one triangle's "
        "vertices");
  CHECK_THAT(refusal_of(x, {{0, 1, 2}, {3, 1, 2}, {5, 4, 3}}),
             Contains("mesh: triangle 1: opposite orientation to its neighbour, triangle 0"));
}

TEST_CASE("indices, coordinates and unused vertices are refused up to the very last") {
  PerParticle3 x = places(4);
  CHECK(refusal_of(x, {{0, 1, 2}, {2, 1, 3}}) == "not refused");
  CHECK(refusal_of(x, {{0, 1, 2}, {2, 1, 4}}) ==
        "mesh: triangle 1: vertex index 4 is out of range; the 4 vertices are counted from 0");
  CHECK_THAT(refusal_of(x, {{-1, 1, 2}, {2, 1, 3}}), Contains("triangle 0: vertex index -1 is"));
  CHECK(refusal_of(x, {{0, 1, 2}}) ==
        "mesh: vertex 3: in no triangle, the first of 1 unused vertices (they would have no mass); "
        "remove them");
  CHECK_THAT(refusal_of(x, {{1, 2, 3}}),
             Contains("mesh: vertex 0: in no triangle, the first of 1"));
  CHECK_THAT(refusal_of(places(9), {{1, 2, 3}, {3, 2, 5}}),
             Contains("mesh: vertex 0: in no triangle, the first of 5"));
  CHECK(refusal_of(x, {}, {"none.obj", {1, 2, 3, 4}, {}}) ==
        "none.obj: no triangles; give at least one");
  for (int axis = 0; axis < 3; ++axis) {
    x = places(4);
    x(axis, 3) = -infinity;
    CHECK(refusal_of(x, {{0, 1, 2}, {2, 1, 3}}) ==
          "mesh: vertex 3: a coordinate is not finite; give numbers in m");
  }
}

TEST_CASE("an origin needs a line for each vertex and each triangle") {
  const PerParticle3 x = places(3);
  CHECK(refusal_of(x, {{0, 1, 2}}, {"", {1, 2, 3, 4}, {}}) == "not refused");
  CHECK(refusal_of(x, {{0, 1, 2}}, {"a.obj", {1, 2, 3}, {4}}) == "not refused");
  CHECK_THROWS_AS(refusal_of(x, {{0, 1, 2}}, {"a.obj", {1, 2}, {4}}), std::logic_error);
  CHECK_THROWS_AS(refusal_of(x, {{0, 1, 2}}, {"a.obj", {1, 2, 3}, {4, 5}}), std::logic_error);
}

TEST_CASE(
    "a triangle has area if it exceeds 1e-12 of its longest side squared, whichever that is") {
  // the height over the longest side, which has the length 5, must exceed 2e-12 * 5
  const Vector3 along = Vector3(3, 4, 0) / 5, up(0, 0, 1);
  for (const double share : {0.1, 0.4, 0.9})
    for (size_t first = 0; first < 3; ++first)
      for (const double height : {2.1e-12, 1.9e-12}) {
        std::array<Vector3, 3> t{Vector3::Zero(), 5 * along, 5 * share * along + 5 * height * up};
        std::rotate(t.begin(), t.begin() + long(first), t.end());
        PerParticle3 x(3, 3);
        x << t[0], t[1], t[2];
        INFO(share << " " << first << " " << height);
        CHECK((refusal_of(x, {{0, 1, 2}}) == "not refused") == (height > 2e-12));
        CHECK((refusal_of(x, {{0, 2, 1}}) == "not refused") == (height > 2e-12));
      }
  PerParticle3 x = places(4);
  x.col(3) = x.col(1);
  CHECK_THAT(refusal_of(x, {{0, 1, 2}, {2, 1, 3}}),
             Contains("mesh: triangle 1: no area: vertex 2, vertex 1 and vertex 3 lie on a line "
                      "(area at most 1e-12 of the longest side squared)"));
}

TEST_CASE("areas, heights, masses and lengths of two triangles are those worked out by hand") {
  // right triangles of the sides 3, 4, 5 and 5, 12, 13 share the side 5
  PerParticle3 x(3, 4);
  x << 1, 4, 1, 4,  //
      2, 2, 6, 2,   //
      7, 7, 7, 19;
  const TriangleMesh mesh = make_triangle_mesh(x, {{0, 1, 2}, {3, 2, 1}});
  const Eigen::VectorXd areas = triangle_areas(mesh.triangles, x);
  CHECK(areas[0] == Approx(6).epsilon(1e-15));
  CHECK(areas[1] == Approx(30).epsilon(1e-15));
  const PerParticle masses = lumped_masses(mesh, 0.7);
  CHECK(masses[0] == Approx(0.7 * 2));
  CHECK(masses[1] == Approx(0.7 * 12));
  CHECK(masses[2] == Approx(0.7 * 12));
  CHECK(masses[3] == Approx(0.7 * 10));
  // edges 01, 02, 12, 13, 23
  const Eigen::VectorXd lengths = rest_lengths(mesh), sides = edge_areas(mesh);
  const std::array<double, 5> long_by_hand{3, 4, 5, 12, 13}, areas_by_hand{6, 6, 36, 30, 30};
  for (int e = 0; e < 5; ++e) {
    CHECK(lengths[e] == Approx(long_by_hand[size_t(e)]).epsilon(1e-15));
    CHECK(sides[e] == Approx(areas_by_hand[size_t(e)]).epsilon(1e-15));
  }
  CHECK(euler_characteristic(mesh) == 1);
  for (const std::vector<Triangle>& order : std::vector<std::vector<Triangle>>{
           {{0, 1, 2}, {3, 2, 1}}, {{3, 2, 1}, {1, 2, 0}}, {{2, 1, 3}, {2, 0, 1}}})
    CHECK(smallest_height(order, x) == Approx(12.0 / 5).epsilon(1e-15));
  CHECK(smallest_height({{3, 2, 1}}, x) == Approx(60.0 / 13).epsilon(1e-15));
  CHECK(smallest_height({{2, 1, 3}}, x) == Approx(60.0 / 13).epsilon(1e-15));
  CHECK(smallest_height({{1, 3, 2}}, x) == Approx(60.0 / 13).epsilon(1e-15));
  CHECK(smallest_height({}, x) == infinity);
}

TEST_CASE("masses need a positive, finite density") {
  const TriangleMesh mesh = make_triangle_mesh(places(3), {{0, 1, 2}});
  CHECK_THROWS_WITH(lumped_masses(mesh, 0),
                    "lumped_masses: density is 0 kg/m^2; give a positive, finite one");
  CHECK_THROWS_WITH(lumped_masses(mesh, infinity), Contains("density is inf kg/m^2"));
  CHECK_THROWS_WITH(lumped_masses(mesh, std::nan("")), Contains("density is nan kg/m^2"));
  CHECK(lumped_masses(mesh, 1e-300).minCoeff() > 0);
}

TEST_CASE("parts of a mesh are named by line and from 1 if it was read, from 0 if it was made") {
  const MeshOrigin made, read{"a/b.obj", {11, 13, 17}, {23, 29}};
  CHECK(triangle_location(made, 1) == "mesh: triangle 1: ");
  CHECK(triangle_location(read, 1) == "a/b.obj:29: ");
  CHECK(vertex_location(made, 2) == "mesh: vertex 2: ");
  CHECK(vertex_location(read, 2) == "a/b.obj:17: ");
  CHECK(mesh_location(made) == "mesh: ");
  CHECK(mesh_location(read) == "a/b.obj: ");
  CHECK(vertex_name(made, 1) == "vertex 1");
  CHECK(vertex_name(read, 1) == "vertex 2 (line 13)");
  CHECK(triangle_name(made, 0) == "triangle 0");
  CHECK(triangle_name(read, 0) == "the face of line 23");
  CHECK(edge_name(made, 2, 0) == "the edge between vertex 2 and vertex 0");
  CHECK(edge_name(read, 0, 2) == "the edge between vertex 1 (line 11) and vertex 3 (line 17)");
  CHECK(position_name({1.23456, -0.000123456, 98765.4}) == "(1.235, -0.0001235, 9.877e+04)");
}
