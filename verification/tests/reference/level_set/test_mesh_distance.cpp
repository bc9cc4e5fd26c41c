// The distance to a mesh: its normals, its search with a bound, and what is on the surface.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include "reference/level_set/mesh_distance.h"
#include "verification/specimens/random.h"

using namespace foldproof;
using Catch::Contains;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double epsilon = std::numeric_limits<double>::epsilon();

const std::vector<Triangle> tetrahedron{{0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {1, 0, 2}};

PerParticle3 irregular() {
  PerParticle3 x(3, 4);
  x << 0.9, -0.7, -0.3, 0.2, -0.1, 0.8, -0.9, 0.1, -0.4, -0.5, -0.2, 0.8;
  return x;
}

Vector3 face_normal(const PerParticle3& x, const Triangle& t) {
  const Vector3 a = x.col(t[0]), b = x.col(t[1]), c = x.col(t[2]);
  return (b - a).cross(c - a).normalized();
}

/// The angle at corner k, from the law of cosines.
double angle_at(const PerParticle3& x, const Triangle& t, int k) {
  const Vector3 own = x.col(t[k]), one = x.col(t[(k + 1) % 3]), other = x.col(t[(k + 2) % 3]);
  const double a = (one - own).norm(), b = (other - own).norm(), c = (one - other).norm();
  return std::acos((a * a + b * b - c * c) / (2 * a * b));
}

bool has(const Triangle& t, int vertex) { return std::count(t.begin(), t.end(), vertex) > 0; }

Vector3 vertex_normal(const PerParticle3& x, const std::vector<Triangle>& triangles, int vertex) {
  Vector3 sum = Vector3::Zero();
  for (const Triangle& t : triangles)
    for (int k = 0; k < 3; ++k)
      if (t[k] == vertex) sum += angle_at(x, t, k) * face_normal(x, t);
  return sum.normalized();
}

Vector3 edge_normal(const PerParticle3& x, const std::vector<Triangle>& triangles, int a, int b) {
  Vector3 sum = Vector3::Zero();
  for (const Triangle& t : triangles)
    if (has(t, a) && has(t, b)) sum += face_normal(x, t);
  return sum.normalized();
}

/// A strip of triangles with corners anywhere.
MeshDistance tangle(int triangles, unsigned seed) {
  Random random(seed);
  std::vector<Triangle> all;
  for (int t = 0; t < triangles; ++t) all.push_back({t, t + 1, t + 2});
  return make_mesh_distance(random.vectors(triangles + 2, 1.7), all);
}

}  // namespace

TEST_CASE("a mesh's normals are sums over faces: two at an edge, by angles at a vertex") {
  const PerParticle3 x = irregular();
  const MeshDistance mesh = make_mesh_distance(x, tetrahedron);
  REQUIRE(mesh.normals.size() == 4);
  REQUIRE(mesh.corners.size() == 4);
  for (int i = 0; i < 4; ++i) {
    const Triangle& t = tetrahedron[mesh.tree.order[i]];
    for (int k = 0; k < 3; ++k) {
      CHECK(mesh.corners[i][k] == Vector3(x.col(t[k])));
      CHECK((mesh.normals[i][k] - vertex_normal(x, tetrahedron, t[k])).norm() < 1e-14);
      const Vector3 edge = edge_normal(x, tetrahedron, t[k], t[(k + 1) % 3]);
      CHECK((mesh.normals[i][3 + k] - edge).norm() < 1e-14);
    }
    CHECK((mesh.normals[i][6] - face_normal(x, t)).norm() < 1e-14);
  }
}

TEST_CASE("a mesh's normals are unit vectors however small the mesh is") {
  const MeshDistance mesh = make_mesh_distance(1e-3 * irregular(), tetrahedron);
  for (const auto& normals : mesh.normals)
    for (const Vector3& normal : normals) CHECK(normal.norm() == Approx(1).epsilon(1e-14));
}

TEST_CASE("a triangle without area has no normal and no weight in those of its neighbours") {
  PerParticle3 x(3, 5);
  x << 0, 2, 0, 1, 0.7, 0, 0, 3, 0, 0.1, 0, 0, 0, 0, 1;
  // the second triangle lies on the first one's edge
  const std::vector<Triangle> triangles{{0, 1, 2}, {0, 3, 1}, {1, 0, 4}};
  const MeshDistance mesh = make_mesh_distance(x, triangles);
  const Vector3 first = face_normal(x, triangles[0]), last = face_normal(x, triangles[2]);
  for (int i = 0; i < 3; ++i) {
    const int t = mesh.tree.order[i];
    if (t == 1) {
      CHECK(mesh.normals[i][6] == Vector3::Zero());
      CHECK(mesh.normals[i][1] == Vector3::Zero());  // a vertex of this triangle only
      CHECK((mesh.normals[i][5] - (first + last).normalized()).norm() < 1e-14);
    }
    if (t == 0) CHECK((mesh.normals[i][3] - (first + last).normalized()).norm() < 1e-14);
  }
}

TEST_CASE("a mesh keeps its vertices and triangles, and names what is rounding error to it") {
  PerParticle3 x = irregular();
  x(1, 2) = -3;  // the largest coordinate
  const MeshDistance mesh = make_mesh_distance(x, tetrahedron);
  CHECK(mesh.x == x);
  CHECK(mesh.triangles == tetrahedron);
  CHECK(mesh.resolution == 48 * epsilon);
  CHECK(MeshDistance{}.resolution == 0);
}

TEST_CASE("a mesh without triangles has no distance") {
  CHECK_THROWS_AS(make_mesh_distance(irregular(), {}), InputError);
  CHECK_THROWS_WITH(make_mesh_distance(irregular(), {}), Contains("give at least one"));
}

TEST_CASE("leaves of a mesh's tree hold up to four triangles") {
  CHECK(tangle(4, 931).tree.nodes.size() == 1);
  CHECK(tangle(5, 931).tree.nodes.size() == 3);
}

TEST_CASE("the nearest feature is that of the nearest triangle, with and without a bound") {
  Random random(932);
  for (const int triangles : {1, 5, 37}) {
    const MeshDistance mesh = tangle(triangles, 933);
    for (int i = 0; i < 200; ++i) {
      const Vector3 p = random.vectors(1, 3).col(0);
      double least = infinity;
      for (const Corners3& corners : mesh.corners)
        least = std::min(least, nearest_on_triangle(corners, p).squared_distance);
      const NearestFeature found = nearest_feature(mesh, p, infinity);
      CHECK(found.squared_distance == least);
      REQUIRE(found.triangle >= 0);
      CHECK(nearest_on_triangle(mesh.corners[found.triangle], p).squared_distance == least);
      CHECK((p - found.point).squaredNorm() == least);
      CHECK(nearest_feature(mesh, p, 1.001 * std::sqrt(least)).triangle == found.triangle);
      const NearestFeature none = nearest_feature(mesh, p, 0.999 * std::sqrt(least));
      CHECK(none.triangle == -1);
    }
  }
}

TEST_CASE("a feature exactly at the bound is not closer than it") {
  PerParticle3 x(3, 3);
  x << 0, 4, 0, 0, 0, 4, 3, 3, 3;
  const MeshDistance mesh = make_mesh_distance(x, {{0, 1, 2}});
  CHECK(nearest_feature(mesh, {1, 1, 0.5}, 2.5).triangle == -1);
  CHECK(nearest_feature(mesh, {1, 1, 0.5}, 2.5000001).triangle == 0);
}

TEST_CASE("of two triangles at one distance the first of the tree is nearest") {
  PerParticle3 x(3, 6);
  x << 0, 4, 0, 0, 4, 0, 0, 0, 4, 0, 0, 4, 1, 1, 1, -1, -1, -1;
  const MeshDistance mesh = make_mesh_distance(x, {{0, 1, 2}, {3, 4, 5}});
  CHECK(nearest_feature(mesh, {1, 1, 0}, infinity).triangle == 0);
  CHECK(nearest_feature(mesh, {1, 1, 0}, infinity).point.z() == mesh.corners[0][0].z());
}

TEST_CASE("a mesh's distance has the side of the nearest feature's normal") {
  PerParticle3 x(3, 3);
  x << 0, 4, 0, 0, 0, 4, 3, 3, 3;
  const MeshDistance mesh = make_mesh_distance(x, {{0, 1, 2}});  // its normal is +z
  const Distance below = mesh.at({1, 1, 0.5}), above = mesh.at({1, 1, 3.25});
  CHECK(below.phi == -2.5);
  CHECK((below.normal - Vector3(0, 0, 1)).norm() < 1e-15);
  CHECK(above.phi == 0.25);
  CHECK((above.normal - Vector3(0, 0, 1)).norm() < 1e-15);
  const Distance on = mesh.at({1, 1, 3});
  CHECK(on.phi == 0);
  CHECK_FALSE(std::signbit(on.phi));
  CHECK(on.normal == Vector3(0, 0, 1));
}

TEST_CASE("up to its resolution a mesh's normal is the feature's, beyond it points to p") {
  PerParticle3 x = irregular();
  x.col(3) = Vector3(0, 0, 8);  // resolution 2^-45
  const MeshDistance mesh = make_mesh_distance(x, tetrahedron);
  REQUIRE(mesh.resolution == 128 * epsilon);
  const Vector3 apex = vertex_normal(x, tetrahedron, 3);
  const Vector3 up(0, 0, 1);
  REQUIRE((apex - up).norm() > 1e-3);
  const Distance at_limit = mesh.at(Vector3(0, 0, 8) + mesh.resolution * up);
  CHECK(at_limit.phi == mesh.resolution);
  CHECK((at_limit.normal - apex).norm() < 1e-12);
  const Distance beyond = mesh.at(Vector3(0, 0, 8) + 2 * mesh.resolution * up);
  CHECK(beyond.phi == 2 * mesh.resolution);
  CHECK((beyond.normal - up).norm() < 1e-14);
}

TEST_CASE("where a point is no place, a mesh's distance is no number and its normal is zero") {
  const MeshDistance mesh = make_mesh_distance(irregular(), tetrahedron);
  const Distance found = mesh.at({0.1, NAN, 0.2});
  CHECK(std::isnan(found.phi));
  CHECK(found.normal == Vector3::Zero());
}
