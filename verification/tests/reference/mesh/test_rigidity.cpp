// Rigidity of flat meshes, against hinges that are bent by a little.
#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <cmath>

#include "reference/mesh/rigidity_map.h"
#include "reference/mesh/shapes.h"

using namespace foldproof;

namespace {

/// A sheet of random triangles, turned out of the coordinate planes and moved.
TriangleMesh tilted_sheet() {
  TriangleMesh mesh = make_sheet({SheetPattern::random_delaunay, 1.3, 0.9, 4, 3, 0, 5});
  const Eigen::AngleAxisd turn(0.7, Vector3(0.3, -0.8, 0.4).normalized());
  mesh.rest = (turn.toRotationMatrix() * mesh.rest).colwise() + Vector3(0.4, -1.7, 2.3);
  return mesh;
}

double fold_angle(const Hinge& hinge, const PerParticle3& x) {
  const auto [v1, v2, v3, v4] = hinge.particles;
  const Vector3 x1 = x.col(v1), x2 = x.col(v2), x3 = x.col(v3), x4 = x.col(v4);
  const Vector3 N1 = (x1 - x3).cross(x1 - x4), N2 = (x2 - x4).cross(x2 - x3), E = x4 - x3;
  return std::atan2(N1.cross(N2).dot(E.normalized()), N1.dot(N2));
}

/// k.R k: twice the energy per area and ke, of the hinges bent to a paraboloid of the curvatures k.
double bent_energy(const TriangleMesh& mesh, const RestPlane& plane, const Eigen::Vector3d& k) {
  const double small = 1e-5;
  const Vector3 normal = plane.first.cross(plane.second);
  PerParticle3 x = mesh.rest;
  for (int i = 0; i < mesh.particles(); ++i) {
    const double a = plane.first.dot(mesh.rest.col(i)), b = plane.second.dot(mesh.rest.col(i));
    x.col(i) += small * 0.5 * (k[0] * a * a + k[1] * b * b + k[2] * a * b) * normal;
  }
  double energy = 0, area = 0;
  for (const Hinge& hinge : mesh.hinges) {
    const auto [v1, v2, v3, v4] = hinge.particles;
    const Vector3 x3 = mesh.rest.col(v3), E = mesh.rest.col(v4) - x3;
    const double twice_areas =
        E.cross(mesh.rest.col(v1) - x3).norm() + E.cross(mesh.rest.col(v2) - x3).norm();
    const double theta = fold_angle(hinge, x) / small;
    energy += E.squaredNorm() / twice_areas * theta * theta / 4;
    area += twice_areas / 2 / 3;
  }
  return 2 * energy / area;
}

}  // namespace

TEST_CASE("the rigidity of a flat mesh is that of its hinges when it is bent by a little") {
  const TriangleMesh mesh = tilted_sheet();
  RestPlane plane;
  REQUIRE(is_flat(mesh, plane));
  const Eigen::Matrix3d R = rigidity_of(mesh, plane).R;
  CHECK((R - R.transpose()).norm() < 1e-14 * R.norm());
  for (const Eigen::Vector3d& k :
       {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0), Eigen::Vector3d(0, 0, 1),
        Eigen::Vector3d(0.7, -0.4, 1.3), Eigen::Vector3d(-0.2, 0.9, 0.5),
        Eigen::Vector3d(1.1, 0.6, -0.8)})
    CHECK(k.dot(R * k) == Approx(bent_energy(mesh, plane, k)).epsilon(1e-7));
}

TEST_CASE(
    "a mesh is flat if no particle is farther from its plane than a millionth of its extent") {
  RestPlane plane;
  for (const double height : {0.99e-6, -0.99e-6, 1.01e-6, -1.01e-6}) {
    PerParticle3 x(3, 5);  // the last about the middle, the extent is 5 from the first on
    x << 0, 3, 3, 0, 0.5, 0, 0, 4, 4, 0.7, 0, 0, 0, 0, 5 * height;
    const TriangleMesh roof = make_triangle_mesh(x, {{4, 0, 1}, {4, 1, 2}, {4, 2, 3}, {4, 3, 0}});
    CHECK(is_flat(roof, plane) == (std::abs(height) < 1e-6));
  }
  CHECK_FALSE(is_flat(make_icosphere(1, 0), plane));
}

TEST_CASE("a pattern of springs has its own Young's modulus") {
  for (const auto& [pattern, modulus] :
       std::vector<std::pair<SheetPattern, double>>{{SheetPattern::criss_cross, 0.75},
                                                    {SheetPattern::union_jack, 1.2},
                                                    {SheetPattern::equilateral, 1}}) {
    const TriangleMesh mesh = make_sheet({pattern, 1, 1, 60, 60});
    RestPlane plane;
    REQUIRE(is_flat(mesh, plane));
    CHECK(membrane_of(mesh, plane).of_strip(0) == Approx(modulus).epsilon(0.02));
  }
}
