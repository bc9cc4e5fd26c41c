#include "verification/specimens/bending_alternatives.h"

#include <Eigen/Geometry>

namespace foldproof {

namespace {

/// A spring of rest length |x1 - x2| at rest joins the far corners.
std::array<Vector3, 4> spring_across(const Corners& x, const Corners& rest) {
  const Vector3 d = x[1] - x[0];
  const double strain = d.norm() / (rest[1] - rest[0]).norm() - 1;
  const Vector3 pull = strain * d.normalized();
  return {pull, -pull, Vector3::Zero(), Vector3::Zero()};
}

/// The condition C = theta with F = -C grad C, the gradient by the shortcut.
std::array<Vector3, 4> constant_lengths(const Corners& x, const Corners&) {
  const Vector3 N1 = (x[0] - x[2]).cross(x[0] - x[3]), N2 = (x[1] - x[3]).cross(x[1] - x[2]);
  const Vector3 n1 = N1.normalized(), n2 = N2.normalized(), e = (x[3] - x[2]).normalized();
  const double theta = std::atan2(n1.cross(n2).dot(e), n1.dot(n2));
  std::array<Vector3, 4> force = shortcut_gradient(x, EdgeLength::taken_as_constant);
  for (Vector3& f : force) f *= -theta;
  return force;
}

double cotangent(const Vector3& a, const Vector3& b) { return a.dot(b) / a.cross(b).norm(); }

// Quadratic bending: W = 3/(2 A) |K1 x1 + K2 x2 + K3 x3 + K4 x4|^2 with A the area of both
// triangles, and K from the cotangents of the angles at x3 and x4 at rest: constant, so that F =
// -3/A K_i (sum K_j x_j).
//
//      x1      c01, c03: cotangents of the angles that the edge makes at x3 and x4 in the triangle
//     /  \              of x1
//   x3 -- x4   c02, c04: the same in the triangle of x2
//     \  /     K3 = c03 + c04,  K4 = c01 + c02,  K1 = -(c01 + c03),  K2 = -(c02 + c04)
//      x2
std::array<Vector3, 4> quadratic(const Corners& x, const Corners& rest) {
  const Vector3 edge = rest[3] - rest[2];
  const double c01 = cotangent(edge, rest[0] - rest[2]), c02 = cotangent(edge, rest[1] - rest[2]);
  const double c03 = cotangent(-edge, rest[0] - rest[3]), c04 = cotangent(-edge, rest[1] - rest[3]);
  const double area =
      (edge.cross(rest[0] - rest[2]).norm() + edge.cross(rest[1] - rest[2]).norm()) / 2;
  const std::array<double, 4> weights = {-(c01 + c03), -(c02 + c04), c03 + c04, c01 + c02};
  Vector3 sum = Vector3::Zero();
  for (int k = 0; k < 4; ++k) sum += weights[k] * x[k];
  std::array<Vector3, 4> force;
  for (int k = 0; k < 4; ++k) force[k] = -3 / area * weights[k] * sum;
  return force;
}

}  // namespace

// theta from sin = (n1 x n2).e and cos = n1.n2: d(theta) = cos d(sin) - sin d(cos), with the
// shortcut dn = dN/|N|, de = dE/|E|, which keeps the lengths constant.
std::array<Vector3, 4> shortcut_gradient(const Corners& x, EdgeLength edge_length) {
  const Vector3 N1 = (x[0] - x[2]).cross(x[0] - x[3]), N2 = (x[1] - x[3]).cross(x[1] - x[2]);
  const Vector3 E = x[3] - x[2], n1 = N1.normalized(), n2 = N2.normalized(), e = E.normalized();
  const double sine = n1.cross(n2).dot(e), cosine = n1.dot(n2);
  std::array<Vector3, 4> gradient;
  for (int corner = 0; corner < 4; ++corner) {
    for (int axis = 0; axis < 3; ++axis) {
      Corners dx = {Vector3::Zero(), Vector3::Zero(), Vector3::Zero(), Vector3::Zero()};
      dx[corner] = Vector3::Unit(axis);
      const Vector3 dN1 = (dx[0] - dx[2]).cross(x[0] - x[3]) + (x[0] - x[2]).cross(dx[0] - dx[3]);
      const Vector3 dN2 = (dx[1] - dx[3]).cross(x[1] - x[2]) + (x[1] - x[3]).cross(dx[1] - dx[2]);
      Vector3 de = (dx[3] - dx[2]) / E.norm();
      if (edge_length == EdgeLength::differentiated) de -= e.dot(de) * e;
      const Vector3 dn1 = dN1 / N1.norm(), dn2 = dN2 / N2.norm();
      const double d_sine = (dn1.cross(n2) + n1.cross(dn2)).dot(e) + n1.cross(n2).dot(de);
      gradient[corner][axis] = cosine * d_sine - sine * (dn1.dot(n2) + n1.dot(dn2));
    }
  }
  return gradient;
}

//   |E|/h = |E| / ((2 A1/|E| + 2 A2/|E|)/6) = 3 |E|^2/(A1 + A2)
std::array<Vector3, 4> discrete_shells_force(const Corners& x, const Corners& rest,
                                             double rest_angle) {
  const Vector3 N1 = (x[0] - x[2]).cross(x[0] - x[3]), N2 = (x[1] - x[3]).cross(x[1] - x[2]);
  const Vector3 n1 = N1.normalized(), n2 = N2.normalized(), e = (x[3] - x[2]).normalized();
  const double theta = std::atan2(n1.cross(n2).dot(e), n1.dot(n2));
  const Vector3 edge = rest[3] - rest[2];
  const double area =
      (edge.cross(rest[0] - rest[2]).norm() + edge.cross(rest[1] - rest[2]).norm()) / 2;
  // with only the normals' lengths taken as constant, the shortcut is exact
  std::array<Vector3, 4> force = shortcut_gradient(x, EdgeLength::differentiated);
  for (Vector3& f : force) f *= -6 * edge.squaredNorm() / area * (theta - rest_angle);
  return force;
}

double quadratic_bending_energy(const Corners& x, const Corners& rest) {
  const std::array<Vector3, 4> force = quadratic(x, rest);
  double twice = 0;  // a quadratic form: W = -x.F/2
  for (int k = 0; k < 4; ++k) twice -= x[k].dot(force[k]);
  return twice / 2;
}

std::vector<BendingAlternative> bending_alternatives() {
  return {
      {"bending.spring-across-the-hinge-acts-in-plane", "A spring between the far corners",
       "springs between second neighbours, as in Provot 1995 and Choi and Ko 2002", spring_across},
      {"bending.constant-length-gradients-act-in-plane",
       "Bending with gradients that take the lengths of normals and edge as constant",
       "Baraff and Witkin 1998, section 4.3, gradients as usually implemented", constant_lengths},
      {"bending.quadratic-bending-acts-in-plane",
       "Quadratic bending, whose weights are those of the rest shape,",
       "Bergou, Wardetzky, Harmon, Zorin, Grinspun 2006", quadratic}};
}

}  // namespace foldproof
