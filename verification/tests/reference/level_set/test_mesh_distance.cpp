// The distance to a mesh: its normals, its search with a bound, and what is on the surface.
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

#include "reference/level_set/mesh_distance.h"

using namespace foldproof;
using Catch::Contains;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

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

MeshDistance lone_triangle() {  // its normal is +z
  PerParticle3 x(3, 3);
  x << 0, 4, 0, 0, 0, 4, 3, 3, 3;
  return make_mesh_distance(x, {{0, 1, 2}});
}

}  // namespace

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

TEST_CASE("a search is within its bound, and of equal triangles the first is nearest") {
  const MeshDistance one = lone_triangle();
  CHECK(nearest_feature(one, {1, 1, 0.5}, 2.5).triangle == -1);
  CHECK(nearest_feature(one, {1, 1, 0.5}, 2.5000001).triangle == 0);
  PerParticle3 x(3, 6);
  x << 0, 4, 0, 0, 4, 0, 0, 0, 4, 0, 0, 4, 1, 1, 1, -1, -1, -1;
  const MeshDistance two = make_mesh_distance(x, {{0, 1, 2}, {3, 4, 5}});
  CHECK(nearest_feature(two, {1, 1, 0}, infinity).triangle == 0);
}

TEST_CASE("a mesh without triangles has no distance, nor has a place that is none") {
  CHECK_THROWS_WITH(make_mesh_distance(irregular(), {}), Contains("give at least one"));
  const Distance found = make_mesh_distance(irregular(), tetrahedron).at({0.1, NAN, 0.2});
  CHECK(std::isnan(found.phi));
  CHECK(found.normal == Vector3::Zero());
}
