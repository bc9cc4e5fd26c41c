// Rigidity of flat meshes, against hinges that are bent by a little.
#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

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

/// k.R k: twice the energy per area and ke, of these hinges bent to a paraboloid of
/// the curvatures k.
double bent_energy(const TriangleMesh& mesh, const std::vector<Hinge>& hinges,
                   const RestPlane& plane, const Eigen::Vector3d& k) {
  const double small = 1e-5;
  const Vector3 normal = plane.first.cross(plane.second);
  PerParticle3 x = mesh.rest;
  for (int i = 0; i < mesh.particles(); ++i) {
    const double a = plane.first.dot(mesh.rest.col(i)), b = plane.second.dot(mesh.rest.col(i));
    x.col(i) += small * 0.5 * (k[0] * a * a + k[1] * b * b + k[2] * a * b) * normal;
  }
  double energy = 0, area = 0;
  for (const Hinge& hinge : hinges) {
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

double cylinder_energy(const TriangleMesh& mesh, const std::vector<Hinge>& hinges,
                       const RestPlane& plane, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return bent_energy(mesh, hinges, plane, {c * c, s * s, 2 * c * s});
}

Eigen::Matrix3d some_rigidity() {
  Eigen::Matrix3d R;
  R << 1.9, 0.3, -0.2, 0.3, 0.8, 0.15, -0.2, 0.15, 0.6;
  return R;
}

/// Bending that only feels curvature along `angle`: D = cos^4 of the angle from there.
Rigidity along_only(double angle, double strength) {
  const double c = std::cos(angle), s = std::sin(angle);
  const Eigen::Vector3d q(c * c, s * s, c * s);
  return {strength * q * q.transpose()};
}

/// Four triangles about the particle `centre`, and how far it lies out of their plane.
TriangleMesh shallow_roof(bool centre_first, double height) {
  PerParticle3 x(3, 5);
  x << 0.5, 0, 3, 3, 0, 0.7, 0, 0, 4, 4, 0, 0, 0, 0, 0;
  x(2, 0) = height;
  std::vector<Triangle> triangles{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1}};
  if (!centre_first) {
    x.col(0).swap(x.col(2));
    for (Triangle& t : triangles)
      for (int& v : t) v = v == 0 ? 2 : v == 2 ? 0 : v;
  }
  return make_triangle_mesh(x, triangles);
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
    CHECK(k.dot(R * k) == Approx(bent_energy(mesh, mesh.hinges, plane, k)).epsilon(1e-7));
}

TEST_CASE("around a particle those hinges count that its triangles touch, once each") {
  const TriangleMesh mesh = tilted_sheet();
  RestPlane plane;
  REQUIRE(is_flat(mesh, plane));
  const std::vector<RigidityExtremes> around = rigidity_around_particles(mesh);
  REQUIRE(around.size() == size_t(mesh.particles()));
  int with = 0;
  for (int i = 0; i < mesh.particles(); ++i) {
    std::vector<Hinge> hinges;
    for (const Hinge& hinge : mesh.hinges) {
      const std::array<int, 2> sides = mesh.edges[size_t(hinge.edge)].triangles;
      if (std::ranges::any_of(
              sides, [&](int t) { return std::ranges::count(mesh.triangles[size_t(t)], i) > 0; }))
        hinges.push_back(hinge);
    }
    const RigidityExtremes& found = around[size_t(i)];
    INFO(i << " of " << hinges.size());
    CHECK(std::isnan(found.least) == (hinges.size() < 3));
    if (hinges.size() < 3) continue;
    ++with;
    double least = std::numeric_limits<double>::infinity(), greatest = 0;
    for (int degrees = 0; degrees < 180; ++degrees) {
      const double D = cylinder_energy(mesh, hinges, plane, degrees * pi / 180);
      least = std::min(least, D), greatest = std::max(greatest, D);
    }
    CHECK(found.least == Approx(least).epsilon(1e-6));
    CHECK(found.greatest == Approx(greatest).epsilon(1e-6));
    CHECK(cylinder_energy(mesh, hinges, plane, found.greatest_angle) ==
          Approx(greatest).epsilon(1e-6));
  }
  CHECK(with > 15);
}

TEST_CASE("a particle with three hinges has a rigidity, one with two has none") {
  // a strip of five triangles
  PerParticle3 x(3, 7);
  x << 0, 0.4, 1, 1.5, 2.1, 2.4, 3.2, 0, 0.9, 0.1, 1.1, -0.1, 1, 0.2, 0, 0, 0, 0, 0, 0, 0;
  const TriangleMesh strip =
      make_triangle_mesh(x, {{0, 2, 1}, {1, 2, 3}, {2, 4, 3}, {3, 4, 5}, {4, 6, 5}});
  const std::vector<RigidityExtremes> around = rigidity_around_particles(strip);
  for (const size_t v : {0u, 1u, 5u, 6u}) {
    CHECK(std::isnan(around[v].least));
    CHECK(std::isnan(around[v].greatest));
    CHECK(std::isnan(around[v].greatest_angle));
  }
  for (const size_t v : {2u, 3u, 4u}) CHECK(around[v].greatest > 0);
  // both sides of one triangle: no plane stands for them
  const TriangleMesh pillow = make_triangle_mesh(x.leftCols(3), {{0, 2, 1}, {0, 1, 2}});
  REQUIRE(pillow.hinges.size() == 3);
  for (const RigidityExtremes& found : rigidity_around_particles(pillow))
    CHECK(std::isnan(found.greatest));
}

TEST_CASE("a cylinder's rigidity is that of the curvature along its angle") {
  const Rigidity rigidity{some_rigidity()};
  for (const double angle : {0.0, 0.3, 1.1, 2.6}) {
    const double K11 = std::pow(std::cos(angle), 2), K22 = std::pow(std::sin(angle), 2),
                 twice_K12 = std::sin(2 * angle);
    CHECK(rigidity.along(angle) ==
          Approx(1.9 * K11 * K11 + 0.8 * K22 * K22 + 0.6 * twice_K12 * twice_K12 +
                 2 * (0.3 * K11 * K22 - 0.2 * K11 * twice_K12 + 0.15 * K22 * twice_K12)));
  }
}

TEST_CASE("a strip's rigidity is the least energy for its curvature along itself") {
  const Rigidity rigidity{some_rigidity()};
  for (const double angle : {0.0, 0.3, 1.1, 2.6}) {
    const double c = std::cos(angle), s = std::sin(angle);
    // least k.R k where a.k = 1, by Lagrange's rule
    Eigen::Matrix4d system = Eigen::Matrix4d::Zero();
    system.topLeftCorner<3, 3>() = 2 * some_rigidity();
    system.block<3, 1>(0, 3) << c * c, s * s, c * s;
    system.block<1, 3>(3, 0) << c * c, s * s, c * s;
    const Eigen::Vector4d solution = system.fullPivLu().solve(Eigen::Vector4d(0, 0, 0, 1));
    const Eigen::Vector3d k = solution.head<3>();
    CHECK(rigidity.of_strip(angle) == Approx(k.dot(some_rigidity() * k)));
    CHECK(rigidity.of_strip(angle) < rigidity.along(angle));
  }
}

TEST_CASE("a strip has no rigidity where the matrix is singular, to 1e-12 of its trace cubed") {
  // determinant 3 d, trace 4
  const auto with = [](double d) { return Rigidity{Eigen::Vector3d(1, d, 3).asDiagonal()}; };
  const double limit = 1e-12 * 64 / 3;
  CHECK(std::isnan(with(0.99 * limit).of_strip(0.4)));
  CHECK(with(1.01 * limit).of_strip(0.4) > 0);
  CHECK(std::isnan(with(-2).of_strip(0.4)));
  CHECK(std::isnan(with(std::nan("")).of_strip(0.4)));
}

TEST_CASE("extremes are those of 180 directions, the first and the last included") {
  for (const int degrees : {0, 1, 37, 90, 178, 179}) {
    INFO(degrees);
    const RigidityExtremes found = extremes_of(along_only(degrees * pi / 180, 0.3));
    CHECK(found.greatest == Approx(0.3));
    CHECK(found.greatest_angle == Approx(degrees * pi / 180).margin(1e-12));
    CHECK(found.least == Approx(0).margin(1e-12));
  }
  // between two directions: the nearer one
  const RigidityExtremes between = extremes_of(along_only(37.3 * pi / 180, 2));
  CHECK(between.greatest == Approx(2 * std::pow(std::cos(0.3 * pi / 180), 4)).epsilon(1e-12));
  CHECK(between.greatest_angle == Approx(37 * pi / 180));
  const RigidityExtremes found = extremes_of({some_rigidity()});
  double least = 9, greatest = 0;
  for (int k = 0; k < 180; ++k) {
    const double D = Rigidity{some_rigidity()}.along(k * pi / 180);
    least = std::min(least, D), greatest = std::max(greatest, D);
  }
  CHECK(found.least == Approx(least));
  CHECK(found.anisotropy() == Approx(greatest / least));
  // c^4 + s^4 is 1 both at 0 and at 90 degrees
  CHECK(extremes_of({Eigen::Vector3d(1, 1, 0).asDiagonal()}).greatest_angle == 0);
}

TEST_CASE(
    "a mesh is flat if no particle is farther from its plane than a millionth of its extent") {
  RestPlane plane;
  for (const bool centre_first : {true, false}) {
    // from the first particle to the farthest
    const double extent = centre_first ? std::hypot(2.5, 3.3) : 5;
    for (const double sign : {-1, 1}) {
      CHECK(is_flat(shallow_roof(centre_first, sign * 0.99e-6 * extent), plane));
      CHECK_FALSE(is_flat(shallow_roof(centre_first, sign * 1.01e-6 * extent), plane));
    }
  }
  PerParticle3 x(3, 4);
  x << 0, 2, 0, 0, 0, 0, 3, 0, 0, 0, 0, 5;
  CHECK_FALSE(is_flat(make_triangle_mesh(x, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}), plane));
}

TEST_CASE(
    "a plane's first direction is along x, or along y if x is within 45 degrees of the normal") {
  const auto plane_of = [](const Vector3& normal) {
    const Vector3 u = normal.unitOrthogonal(), v = normal.cross(u);
    PerParticle3 x(3, 3);
    x << Vector3(0.3, 0.2, -7), Vector3(0.3, 0.2, -7) + 2 * u, Vector3(0.3, 0.2, -7) + 3 * v + u;
    RestPlane plane;
    CHECK(is_flat(make_triangle_mesh(x, {{0, 1, 2}}), plane));
    return plane;
  };
  const std::vector<std::array<Vector3, 3>> by_hand{
      {Vector3(0, 0, 1), Vector3(1, 0, 0), Vector3(0, 1, 0)},
      {Vector3(0.6, 0, 0.8), Vector3(0.8, 0, -0.6), Vector3(0, 1, 0)},
      {Vector3(0.6, 0.8, 0), Vector3(0.8, -0.6, 0), Vector3(0, 0, -1)},
      {Vector3(0, 0.8, -0.6), Vector3(1, 0, 0), Vector3(0, -0.6, -0.8)},
      {Vector3(0.8, 0.6, 0), Vector3(-0.6, 0.8, 0), Vector3(0, 0, 1)},
      {Vector3(-0.8, -0.6, 0), Vector3(-0.6, 0.8, 0), Vector3(0, 0, -1)},
      {Vector3(-0.8, 0, 0.6), Vector3(0, 1, 0), Vector3(-0.6, 0, -0.8)}};
  for (const auto& [normal, first, second] : by_hand) {
    INFO(normal.transpose());
    const RestPlane plane = plane_of(normal);
    CHECK((plane.first - first).norm() < 1e-14);
    CHECK((plane.second - second).norm() < 1e-14);
  }
}
