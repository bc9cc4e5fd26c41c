#include "reference/mesh/rigidity_map.h"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <numbers>

namespace foldproof {

namespace {

//      x1      With w the height of the corners over the plane, cotangents at x3 and x4 (of x1's
//     /  \     triangle c01, c03, of x2's c02, c04) and
//   x3 -- x4   K1 = -(c01 + c03), K2 = -(c02 + c04), K3 = c03 + c04, K4 = c01 + c02,
//     \  /     the hinge turns by theta = sum K_i w_i/|E|, to first order.
//      x2
double cotangent(const Vector3& a, const Vector3& b) { return a.dot(b) / a.cross(b).norm(); }

FlatElement flat_hinge(const TriangleMesh& mesh, const Hinge& hinge, const RestPlane& plane) {
  std::array<Vector3, 4> x;
  for (std::size_t k = 0; k < 4; ++k) x[k] = mesh.rest.col(hinge.particles[k]);
  const Vector3 edge = x[3] - x[2];
  const double c01 = cotangent(edge, x[0] - x[2]), c02 = cotangent(edge, x[1] - x[2]);
  const double c03 = cotangent(-edge, x[0] - x[3]), c04 = cotangent(-edge, x[1] - x[3]);
  const std::array<double, 4> K = {-(c01 + c03), -(c02 + c04), c03 + c04, c01 + c02};
  // |N1| + |N2|
  const double twice_areas = edge.cross(x[0] - x[2]).norm() + edge.cross(x[1] - x[2]).norm();
  const double weight = edge.squaredNorm() / twice_areas / 2;  // c/2: energy = ke c theta^2/4
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();              // q: theta = q.k [m]
  for (std::size_t k = 0; k < 4; ++k) {
    const double a = (x[k] - x[2]).dot(plane.first), b = (x[k] - x[2]).dot(plane.second);
    turn += K[k] * Eigen::Vector3d(a * a / 2, b * b / 2, a * b / 2);
  }
  turn /= edge.norm();
  return {weight * turn * turn.transpose(), twice_areas / 6,
          std::atan2(edge.dot(plane.first), -edge.dot(plane.second))};
}

/// Sums elements: R = the sum of their energies over that of their areas.
struct Sum {
  Eigen::Matrix3d energy = Eigen::Matrix3d::Zero();
  double area = 0;
  int elements = 0;

  void add(const FlatElement& element) {
    energy += element.energy;
    area += element.area;
    ++elements;
  }
  Rigidity rigidity() const { return {energy / area}; }
};

RestPlane plane_across(const Vector3& normal) {
  const Vector3 n = normal.normalized();
  const Vector3 axis =
      std::abs(n.x()) > std::numbers::sqrt2 / 2 ? Vector3::UnitY() : Vector3::UnitX();
  const Vector3 first = (axis - axis.dot(n) * n).normalized();
  return {first, n.cross(first)};
}

Vector3 area_normal(const TriangleMesh& mesh, const Triangle& t) {
  const Vector3 a = mesh.rest.col(t[0]);
  return (mesh.rest.col(t[1]) - a).cross(mesh.rest.col(t[2]) - a);
}

}  // namespace

double Rigidity::along(double angle) const {
  const double c = std::cos(angle), s = std::sin(angle);
  const Eigen::Vector3d k(c * c, s * s, 2 * c * s);
  return k.dot(R * k);
}

// The curvature along the strip is a.k with a = (cos^2, sin^2, cos sin); the least k.R k for a.k =
// 1 is 1/(a.R^{-1} a).
double Rigidity::of_strip(double angle) const {
  const double c = std::cos(angle), s = std::sin(angle);
  const Eigen::Vector3d a(c * c, s * s, c * s);
  const double determinant = R.determinant();
  if (!(determinant > 1e-12 * std::pow(R.trace(), 3)))
    return std::numeric_limits<double>::quiet_NaN();
  return 1 / a.dot(R.inverse() * a);
}

RigidityExtremes extremes_of(const Rigidity& rigidity) {
  constexpr int directions = 180;
  RigidityExtremes found{std::numeric_limits<double>::infinity(), 0, 0};
  for (int k = 0; k < directions; ++k) {
    const double angle = k * std::numbers::pi / directions, D = rigidity.along(angle);
    found.least = std::min(found.least, D);
    if (D > found.greatest) {
      found.greatest = D;
      found.greatest_angle = angle;
    }
  }
  return found;
}

bool is_flat(const TriangleMesh& mesh, RestPlane& plane) {
  Vector3 normal = Vector3::Zero();
  for (const Triangle& t : mesh.triangles) normal += area_normal(mesh, t);
  const Vector3 first = mesh.rest.col(0);
  const double extent = (mesh.rest.colwise() - first).colwise().norm().maxCoeff();
  if (!(normal.norm() > 0)) return false;
  normal.normalize();
  plane = plane_across(normal);
  return (normal.transpose() * (mesh.rest.colwise() - first)).cwiseAbs().maxCoeff() <=
         1e-6 * extent;
}

std::vector<FlatElement> flat_hinges(const TriangleMesh& mesh, const RestPlane& plane) {
  std::vector<FlatElement> elements;
  for (const Hinge& hinge : mesh.hinges) elements.push_back(flat_hinge(mesh, hinge, plane));
  return elements;
}

// In the strain e, a spring of stiffness Y A_e/L0^2 along the unit vector n stores
// Y A_e (n.e n)^2/2. Each triangle lies at three edges.
std::vector<FlatElement> flat_springs(const TriangleMesh& mesh, const RestPlane& plane) {
  const Eigen::VectorXd areas = edge_areas(mesh);
  std::vector<FlatElement> elements;
  for (size_t e = 0; e < mesh.edges.size(); ++e) {
    const Edge& edge = mesh.edges[e];
    const Vector3 n = (mesh.rest.col(edge.b) - mesh.rest.col(edge.a)).normalized();
    const double c = n.dot(plane.first), s = n.dot(plane.second), area = areas[Eigen::Index(e)];
    const Eigen::Vector3d a(c * c, s * s, c * s);
    elements.push_back({area * a * a.transpose(), area / 3, std::atan2(s, c)});
  }
  return elements;
}

Rigidity rigidity_of(const TriangleMesh& mesh, const RestPlane& plane) {
  Sum sum;
  for (const FlatElement& hinge : flat_hinges(mesh, plane)) sum.add(hinge);
  return sum.rigidity();
}

Rigidity membrane_of(const TriangleMesh& mesh, const RestPlane& plane) {
  Sum sum;
  for (const FlatElement& spring : flat_springs(mesh, plane)) sum.add(spring);
  return sum.rigidity();
}

std::vector<RigidityExtremes> rigidity_around_particles(const TriangleMesh& mesh) {
  std::vector<Vector3> normals(std::size_t(mesh.particles()), Vector3::Zero());
  std::vector<std::vector<int>> corners(std::size_t(mesh.particles()));
  for (int t = 0; t < int(mesh.triangles.size()); ++t)
    for (const int i : mesh.triangles[std::size_t(t)]) {
      normals[std::size_t(i)] += area_normal(mesh, mesh.triangles[std::size_t(t)]);
      corners[std::size_t(i)].push_back(t);
    }
  std::vector<std::vector<int>> hinges_of(mesh.triangles.size());
  for (int k = 0; k < int(mesh.hinges.size()); ++k)
    for (const int t : mesh.edges[std::size_t(mesh.hinges[std::size_t(k)].edge)].triangles)
      hinges_of[std::size_t(t)].push_back(k);

  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  std::vector<RigidityExtremes> around(std::size_t(mesh.particles()), {none, none, none});
  std::vector<int> last_use(mesh.hinges.size(), -1);
  for (std::size_t i = 0; i < around.size(); ++i) {
    Sum sum;
    if (!(normals[i].norm() > 0)) continue;
    const RestPlane plane = plane_across(normals[i]);
    for (const int t : corners[i])
      for (const int k : hinges_of[std::size_t(t)]) {
        if (last_use[std::size_t(k)] == int(i)) continue;
        last_use[std::size_t(k)] = int(i);
        sum.add(flat_hinge(mesh, mesh.hinges[std::size_t(k)], plane));
      }
    if (sum.elements >= 3) around[i] = extremes_of(sum.rigidity());
  }
  return around;
}

}  // namespace foldproof
