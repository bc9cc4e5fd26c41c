#include "reference/forces/bending.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "reference/forces/degenerate.h"

namespace foldproof {

namespace {

// Squared ratio of height to edge below which a triangle counts as degenerate: at 1e-10 of the edge
// the normal is rounding error.
constexpr double smallest_height_squared = 1e-20;

double sine_magnitude(double theta, double rest_angle) {
  return std::sin(theta / 2) - std::sin(rest_angle / 2);
}

double sine_slope(double theta, double) { return 0.5 * std::cos(theta / 2); }

double sine_potential(double theta, double rest_angle) {
  // 2 (cos(theta0/2) - cos(theta/2)) as a product of sines: no digits are lost near a rest angle of
  // 0; near others the error is about tan(theta0/2)/(theta - theta0) roundings
  const double difference = std::sin((theta - rest_angle) / 4);
  if (rest_angle == 0) return 4 * difference * difference;
  return 4 * std::sin((theta + rest_angle) / 4) * difference -
         std::sin(rest_angle / 2) * (theta - rest_angle);
}

double cubic_magnitude(double theta, double rest_angle) {
  const double change = theta - rest_angle;
  return 0.5 * change * (1 + change * change);
}

double cubic_slope(double theta, double rest_angle) {
  return 0.5 + 1.5 * (theta - rest_angle) * (theta - rest_angle);
}

double cubic_potential(double theta, double rest_angle) {
  const double squared = (theta - rest_angle) * (theta - rest_angle);
  return 0.25 * squared + 0.125 * squared * squared;
}

}  // namespace

const std::vector<BendingLaw>& bending_laws() {
  static const std::vector<BendingLaw> laws = {
      {"sine", sine_magnitude, sine_slope, sine_potential},
      {"cubic", cubic_magnitude, cubic_slope, cubic_potential}};
  return laws;
}

const BendingLaw& bending_law(std::string_view name) {
  std::string known;
  for (const BendingLaw& law : bending_laws()) {
    if (law.name == name) return law;
    known += (known.empty() ? "" : ", ") + std::string(law.name);
  }
  throw InputError("unknown bending law '" + std::string(name) + "'; known: " + known);
}

HingeShape hinge_shape(const Vector3& x1, const Vector3& x2, const Vector3& x3, const Vector3& x4) {
  const Vector3 E = x4 - x3, to1 = x1 - x4, to2 = x2 - x4;
  const Vector3 N1 = (x1 - x3).cross(to1), N2 = to2.cross(x2 - x3);
  const double E_squared = E.squaredNorm(), N1_squared = N1.squaredNorm(),
               N2_squared = N2.squaredNorm();
  const Eigen::Array2d length = Eigen::Array2d(N1_squared, N2_squared).sqrt(),
                       per_length = 1 / length;
  const double edge = std::sqrt(E_squared), per_edge_squared = 1 / E_squared;
  const double per_length1 = per_length[0], per_length2 = per_length[1];

  HingeShape shape;
  shape.u1 = (edge * per_length1 * per_length1) * N1;
  shape.u2 = (edge * per_length2 * per_length2) * N2;
  shape.b1 = -to1.dot(E) * per_edge_squared;
  shape.b2 = -to2.dot(E) * per_edge_squared;
  shape.edge = edge;
  shape.area_sum = length[0] + length[1];
  const double smallest = smallest_height_squared * E_squared * E_squared;
  shape.degenerate = !(N1_squared > smallest && N2_squared > smallest);

  // sin(theta) = (n1 x n2).e^ is the height of x2 below the first triangle's plane over its
  // distance from the edge. Folded less than a right angle, sin(theta/2) = sin(theta)/(2
  // cos(theta/2)): exactly 0 when flat, no digit lost beside it. Beyond, the printed sqrt((1 -
  // n1.n2)/2), which is accurate just there; a sine of -0 counts as positive, like one of 0.
  const double cosine = N1.dot(N2) * (per_length1 * per_length2);
  const double sine = N1.dot(x3 - x2) * (edge * per_length1 * per_length2);
  shape.sine = N1.dot(x3 - x2) * edge;
  shape.cosine = N1.dot(N2);
  shape.sin_half = cosine >= 0 ? sine / std::sqrt(2 + 2 * cosine)
                               : std::copysign(std::sqrt(0.5 - 0.5 * cosine), sine + 0.0);
  return shape;
}

double HingeShape::angle() const {
  return std::atan2(sine + 0.0, cosine);  // + 0: a sine of -0 counts as positive, too
}

double hinge_angle(const Vector3& x1, const Vector3& x2, const Vector3& x3, const Vector3& x4) {
  return hinge_shape(x1, x2, x3, x4).angle();
}

HingeShape checked_hinge_shape(const BendingHinge& hinge, const PerParticle3& x) {
  const auto [i1, i2, i3, i4] = hinge.particles;
  const HingeShape shape = hinge_shape(x.col(i1), x.col(i2), x.col(i3), x.col(i4));
  if (shape.degenerate)
    throw DegenerateElement("a triangle of a hinge has lost its area", {i1, i2, i3, i4});
  return shape;
}

double weight_of(const BendingHinge& hinge, const HingeShape& shape, Weighting weighting) {
  return weighting == Weighting::rest ? hinge.rest_weight
                                      : shape.edge * shape.edge / shape.area_sum;
}

Eigen::Matrix<double, 3, 4> bending_mode(const HingeShape& shape) {
  Eigen::Matrix<double, 3, 4> u;
  u.col(0) = shape.u1;
  u.col(1) = shape.u2;
  u.col(2) = -(shape.b1 * shape.u1 + shape.b2 * shape.u2);
  u.col(3) = -((1 - shape.b1) * shape.u1 + (1 - shape.b2) * shape.u2);
  return u;
}

double magnitude_of(const BendingLaw& law, const BendingHinge& hinge, const HingeShape& shape) {
  return law.magnitude == sine_magnitude ? shape.sin_half - hinge.sin_half_rest
                                         : law.magnitude(shape.angle(), hinge.rest_angle);
}

HingeShapes Bending::shapes_at(const PerParticle3& x) const {
  return hinges.map([&](const BendingHinge& hinge) { return checked_hinge_shape(hinge, x); });
}

void Bending::add_elastic(const State&, const HingeShapes& shapes, PerParticle3& f) const {
  const BendingLaw& law = bending_law(material.law);
  hinges.push(shapes, f, [&](const BendingHinge& hinge, const HingeShape& shape, const auto& to) {
    const double size = material.stiffness * weight_of(hinge, shape, material.weighting) *
                        magnitude_of(law, hinge, shape);
    const Vector3 f1 = size * shape.u1, f2 = size * shape.u2;
    const Vector3 f3 = -(shape.b1 * f1 + shape.b2 * f2);
    const auto [i1, i2, i3, i4] = hinge.particles;
    to.add(i1, f1);
    to.add(i2, f2);
    to.add(i3, f3);
    to.add(i4, -(f1 + f2 + f3));
  });
}

double Bending::energy(const State&, const HingeShapes& shapes) const {
  const BendingLaw& law = bending_law(material.law);
  return material.stiffness *
         hinges.sum(shapes, [&](const BendingHinge& hinge, const HingeShape& shape) {
           return weight_of(hinge, shape, material.weighting) *
                  law.potential(shape.angle(), hinge.rest_angle);
         });
}

void Bending::prepare_damping(const State&, const HingeShapes& shapes,
                              DampingOperator& damping) const {
  if (material.damping == 0) return;
  const bool by_edge = material.damping_factor == DampingFactor::edge;
  damping.hinges.append(
      hinges.map(shapes, [&](const BendingHinge& hinge, const HingeShape& shape) -> HingeDamper {
        const double factor = by_edge ? shape.edge : shape.edge * shape.edge / shape.area_sum;
        const double root = std::sqrt(material.damping * factor);
        return {hinge.particles, shape.b1, shape.b2, root * shape.u1, root * shape.u2};
      }));
}

std::vector<double> hinge_angles(const TriangleMesh& mesh, const PerParticle3& x) {
  std::vector<double> angles;
  angles.reserve(mesh.hinges.size());
  for (const Hinge& hinge : mesh.hinges) {
    const auto [i1, i2, i3, i4] = hinge.particles;
    angles.push_back(hinge_angle(x.col(i1), x.col(i2), x.col(i3), x.col(i4)));
  }
  return angles;
}

Bending make_bending(const TriangleMesh& mesh, const BendingMaterial& material,
                     const std::vector<double>& rest_angles) {
  if (!(material.stiffness >= 0)) throw InputError("bending: stiffness must be a number >= 0 [J]");
  if (!(material.damping >= 0)) throw InputError("bending: damping must be a number >= 0 [N s]");
  if (rest_angles.size() != mesh.hinges.size())
    throw InputError("bending: " + std::to_string(rest_angles.size()) + " rest angles given for " +
                     std::to_string(mesh.hinges.size()) + " hinges");
  bending_law(material.law);

  // at a seam of a pattern only lengths and areas are known
  const bool is_sewn = !mesh.pattern.empty();
  const Eigen::VectorXd lengths = is_sewn ? rest_lengths(mesh) : Eigen::VectorXd(),
                        areas = is_sewn ? edge_areas(mesh) : Eigen::VectorXd();
  Bending bending{material, {}};
  bending.hinges.reserve(mesh.hinges.size());
  for (size_t h = 0; h < mesh.hinges.size(); ++h) {
    const double theta0 = rest_angles[h];
    if (!(std::abs(theta0) <= pi))
      throw InputError("bending: rest angles must lie in [-pi, pi] rad");
    BendingHinge hinge{mesh.hinges[h].particles, 0, theta0, std::sin(theta0 / 2)};
    const int edge = mesh.hinges[h].edge;
    if (is_sewn) {
      hinge.rest_weight = lengths[edge] * lengths[edge] / (2 * areas[edge]);
    } else {
      const HingeShape shape = checked_hinge_shape(hinge, mesh.rest);
      hinge.rest_weight = shape.edge * shape.edge / shape.area_sum;
    }
    bending.hinges.push_back(hinge);
  }
  return bending;
}

}  // namespace foldproof
