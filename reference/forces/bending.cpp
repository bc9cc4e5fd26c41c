#include "reference/forces/bending.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "reference/forces/degenerate.h"

namespace foldproof {

namespace {

constexpr double pi = 3.14159265358979323846;

// Squared height over edge below which a triangle counts as degenerate: at 1e-10 of the edge rounding has
// eaten the normal.
constexpr double smallest_height_squared = 1e-20;

HingeShape shape_of(const BendingHinge& hinge, const PerParticle3& x) {
  const auto [i1, i2, i3, i4] = hinge.particles;
  return hinge_shape(x.col(i1), x.col(i2), x.col(i3), x.col(i4));
}

HingeShape checked_shape_of(const BendingHinge& hinge, const PerParticle3& x) {
  HingeShape shape = shape_of(hinge, x);
  if (shape.degenerate) {
    const auto& p = hinge.particles;
    throw DegenerateElement("a triangle of a hinge has lost its area", {p[0], p[1], p[2], p[3]});
  }
  return shape;
}

double angle_of(const HingeShape& shape) {
  return 2 * std::asin(std::min(1.0, std::max(-1.0, shape.sin_half)));
}

double weight_of(const BendingHinge& hinge, const HingeShape& shape, Weighting weighting) {
  return weighting == Weighting::rest ? hinge.rest_weight : shape.edge * shape.edge / shape.area_sum;
}

void add_forces(const std::array<int, 4>& particles, const HingeShape& shape, double magnitude,
                PerParticle3& f) {
  const Vector3 f1 = magnitude * shape.u1, f2 = magnitude * shape.u2;
  const Vector3 f3 = -(shape.b1 * f1 + shape.b2 * f2);
  f.col(particles[0]) += f1;
  f.col(particles[1]) += f2;
  f.col(particles[2]) += f3;
  f.col(particles[3]) -= f1 + f2 + f3;
}

double sine_magnitude(double theta, double rest_angle) {
  return std::sin(theta / 2) - std::sin(rest_angle / 2);
}

double sine_slope(double theta, double) { return 0.5 * std::cos(theta / 2); }

double sine_potential(double theta, double rest_angle) {
  // 2 (cos(theta0/2) - cos(theta/2)) as a product of sines, which loses no digits near the rest angle
  return 4 * std::sin((theta + rest_angle) / 4) * std::sin((theta - rest_angle) / 4) -
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
  static const std::vector<BendingLaw> laws = {{"sine", sine_magnitude, sine_slope, sine_potential},
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
  const double E_squared = E.squaredNorm(), N1_squared = N1.squaredNorm(), N2_squared = N2.squaredNorm();
  const double edge = std::sqrt(E_squared), length1 = std::sqrt(N1_squared), length2 = std::sqrt(N2_squared);
  const double per_edge_squared = 1 / E_squared, per_length1 = 1 / length1, per_length2 = 1 / length2;

  HingeShape shape;
  shape.u1 = (edge * per_length1 * per_length1) * N1;
  shape.u2 = (edge * per_length2 * per_length2) * N2;
  shape.b1 = -to1.dot(E) * per_edge_squared;
  shape.b2 = -to2.dot(E) * per_edge_squared;
  shape.edge = edge;
  shape.area_sum = length1 + length2;
  const double smallest = smallest_height_squared * E_squared * E_squared;
  shape.degenerate = !(N1_squared > smallest && N2_squared > smallest);

  // sin(theta) = (n1 x n2).e^ is the height of x2 below the first triangle's plane over its distance from the
  // edge. Folded less than a right angle, sin(theta/2) = sin(theta)/(2 cos(theta/2)): exactly 0 when flat, no
  // digit lost beside it. Beyond, the printed sqrt((1 - n1.n2)/2), which is accurate just there.
  const double cosine = N1.dot(N2) * (per_length1 * per_length2);
  const double sine = N1.dot(x3 - x2) * (edge * per_length1 * per_length2);
  shape.sin_half =
      cosine >= 0 ? sine / std::sqrt(2 + 2 * cosine) : std::copysign(std::sqrt(0.5 - 0.5 * cosine), sine);
  return shape;
}

double hinge_angle(const Vector3& x1, const Vector3& x2, const Vector3& x3, const Vector3& x4) {
  const Vector3 E = x4 - x3, N1 = (x1 - x3).cross(x1 - x4), N2 = (x2 - x4).cross(x2 - x3);
  return std::atan2(N1.dot(x3 - x2) * E.norm(), N1.dot(N2));
}

Eigen::Matrix<double, 3, 4> bending_mode(const HingeShape& shape) {
  Eigen::Matrix<double, 3, 4> u;
  u.col(0) = shape.u1;
  u.col(1) = shape.u2;
  u.col(2) = -(shape.b1 * shape.u1 + shape.b2 * shape.u2);
  u.col(3) = -((1 - shape.b1) * shape.u1 + (1 - shape.b2) * shape.u2);
  return u;
}

void Bending::add_elastic(const State& s, PerParticle3& f) const {
  const BendingLaw& law = bending_law(material.law);
  const bool is_sine = law.magnitude == sine_magnitude;  // needs no angle, only its sine
  for (const BendingHinge& hinge : hinges) {
    const HingeShape shape = checked_shape_of(hinge, s.x);
    const double magnitude =
        is_sine ? shape.sin_half - hinge.sin_half_rest : law.magnitude(angle_of(shape), hinge.rest_angle);
    add_forces(hinge.particles, shape,
               material.stiffness * weight_of(hinge, shape, material.weighting) * magnitude, f);
  }
}

double Bending::energy(const State& s) const {
  const BendingLaw& law = bending_law(material.law);
  double sum = 0;
  for (const BendingHinge& hinge : hinges) {
    const HingeShape shape = checked_shape_of(hinge, s.x);
    const auto [i1, i2, i3, i4] = hinge.particles;
    const double theta = hinge_angle(s.x.col(i1), s.x.col(i2), s.x.col(i3), s.x.col(i4));
    sum += weight_of(hinge, shape, material.weighting) * law.potential(theta, hinge.rest_angle);
  }
  return material.stiffness * sum;
}

namespace {

/// The matrix of the product w x.
Eigen::Matrix3d cross_matrix(const Vector3& w) {
  Eigen::Matrix3d matrix;
  matrix << 0, -w.z(), w.y(), w.z(), 0, -w.x(), -w.y(), w.x(), 0;
  return matrix;
}

using Rows3 = Eigen::Matrix<double, 3, 12>;
using Row = Eigen::Matrix<double, 1, 12>;

/// How u_k and b_k of one triangle change with x1, x2, x3, x4; k its opposite vertex, 0 or 1.
struct SideGradient {
  Rows3 u;  // [1/m^2]
  Row b;    // [1/m]
};

//   N = (x_k - x_l) x (x_k - x_r), (l, r) = (3, 4) for k = 1 and (4, 3) for k = 2, so that N2 = (x2 - x4) x
//   (x2 - x3)
//   dN = (x_r - x_l) x dx_k + (x_k - x_r) x dx_l - (x_k - x_l) x dx_r
//   u = |E| N/|N|^2:   du = N/|N|^2 d|E| + |E|/|N|^2 (I - 2 n n^T) dN,       d|E| = e^.(dx4 - dx3)
//   b = (x4 - x_k).E/|E|^2:   |E|^2 db = (dx4 - dx_k).E + (x4 - x_k).dE - 2 b E.dE
SideGradient side_gradient(const std::array<Vector3, 4>& x, int k) {
  const int l = k == 0 ? 2 : 3, r = k == 0 ? 3 : 2;
  const auto at = [&](int i) -> const Vector3& { return x[size_t(i)]; };
  const Vector3 E = at(3) - at(2), N = (at(k) - at(l)).cross(at(k) - at(r));
  const double edge = E.norm(), N_squared = N.squaredNorm();

  Rows3 dN = Rows3::Zero();
  dN.middleCols<3>(3 * k) = cross_matrix(at(r) - at(l));
  dN.middleCols<3>(3 * l) = cross_matrix(at(k) - at(r));
  dN.middleCols<3>(3 * r) = -cross_matrix(at(k) - at(l));
  Rows3 dE = Rows3::Zero();
  dE.middleCols<3>(6) = -Eigen::Matrix3d::Identity();
  dE.middleCols<3>(9) = Eigen::Matrix3d::Identity();
  Rows3 from_k = Rows3::Zero();  // d(x4 - x_k)
  from_k.middleCols<3>(9) = Eigen::Matrix3d::Identity();
  from_k.middleCols<3>(3 * k) = -Eigen::Matrix3d::Identity();

  const Eigen::Matrix3d turn = Eigen::Matrix3d::Identity() - 2 / N_squared * (N * N.transpose());
  const Vector3 to_k = at(3) - at(k);
  const double b = to_k.dot(E) / (edge * edge);
  SideGradient gradient;
  gradient.u = (N / (N_squared * edge)) * (E.transpose() * dE) + (edge / N_squared) * (turn * dN);
  gradient.b = (E.transpose() * from_k + (to_k - 2 * b * E).transpose() * dE) / (edge * edge);
  return gradient;
}

}  // namespace

Matrix12 bending_mode_gradient(const Vector3& x1, const Vector3& x2, const Vector3& x3, const Vector3& x4) {
  const HingeShape shape = hinge_shape(x1, x2, x3, x4);
  const SideGradient side1 = side_gradient({x1, x2, x3, x4}, 0), side2 = side_gradient({x1, x2, x3, x4}, 1);

  // u3 = -(b1 u1 + b2 u2), u4 = -(u1 + u2 + u3)
  Matrix12 gradient;
  gradient.middleRows<3>(0) = side1.u;
  gradient.middleRows<3>(3) = side2.u;
  gradient.middleRows<3>(6) =
      -(shape.u1 * side1.b + shape.b1 * side1.u + shape.u2 * side2.b + shape.b2 * side2.u);
  gradient.middleRows<3>(9) =
      -(gradient.middleRows<3>(0) + gradient.middleRows<3>(3) + gradient.middleRows<3>(6));
  return gradient;
}

void Bending::add_elastic_differential(const State& s, Definiteness definiteness,
                                       ElasticDifferential& differential) const {
  const BendingLaw& law = bending_law(material.law);
  differential.hinges.reserve(differential.hinges.size() + hinges.size());
  for (const BendingHinge& hinge : hinges) {
    const HingeShape shape = checked_shape_of(hinge, s.x);
    const double theta = angle_of(shape),
                 weight = material.stiffness * weight_of(hinge, shape, material.weighting);
    const auto [i1, i2, i3, i4] = hinge.particles;
    const Eigen::Matrix<double, 3, 4> mode = bending_mode(shape);
    const Eigen::Map<const Eigen::Matrix<double, 12, 1>> u(mode.data());
    const Matrix12 gradient = bending_mode_gradient(s.x.col(i1), s.x.col(i2), s.x.col(i3), s.x.col(i4));
    const Matrix12 block = weight * (law.magnitude(theta, hinge.rest_angle) * gradient -
                                     law.slope(theta, hinge.rest_angle) * (u * u.transpose()));
    differential.hinges.push_back(
        {hinge.particles, definiteness == Definiteness::exact ? block : negative_part(block)});
  }
}

void Bending::prepare_damping(const State& s, DampingOperator& damping) const {
  if (material.damping == 0) return;
  damping.hinges.reserve(damping.hinges.size() + hinges.size());
  for (const BendingHinge& hinge : hinges) {
    const HingeShape shape = checked_shape_of(hinge, s.x);
    const double factor = material.damping_factor == DampingFactor::edge
                              ? shape.edge
                              : shape.edge * shape.edge / shape.area_sum;
    const double root = std::sqrt(material.damping * factor);
    damping.hinges.push_back({hinge.particles, shape.b1, shape.b2, root * shape.u1, root * shape.u2});
  }
}

namespace {

/// Bounds on the rows of grad u, for each particle i the sum over j of |du_i/dx_j| [1/m^2]. With l_km the
/// distance from x_k to x_m, e = |E|, and d(N/|N|^2) = dN/|N|^2 in size, u_k = |E| N_k/|N_k|^2 gives for k =
/// 1, 2
///   |du_k/dx_k| = |u_k|^2,   |du_k/dx_3| <= g_k4,   |du_k/dx_4| <= g_k3,   g_km = |u_k|^2 l_km/e + |u_k|/e,
/// the same for du_3/dx_k and du_4/dx_k since grad u is symmetric, and, with |db_k/dx_3| = l_k4/e^2 and
/// |db_k/dx_4| = l_k3/e^2, the rest from u_3 = -(b_1 u_1 + b_2 u_2) and u_4 = -((1 - b_1) u_1 + (1 - b_2)
/// u_2).
Eigen::Vector4d mode_gradient_rows(const HingeShape& shape, const std::array<int, 4>& particles,
                                   const PerParticle3& x) {
  const Vector3 x3 = x.col(particles[2]), x4 = x.col(particles[3]);
  const double e = shape.edge, size[2] = {shape.u1.norm(), shape.u2.norm()}, b[2] = {shape.b1, shape.b2};
  Eigen::Vector4d rows = Eigen::Vector4d::Zero();
  for (int k = 0; k < 2; ++k) {
    const double to3 = (x.col(particles[size_t(k)]) - x3).norm(),
                 to4 = (x.col(particles[size_t(k)]) - x4).norm();
    const double g3 = size[k] * (size[k] * to3 + 1) / e, g4 = size[k] * (size[k] * to4 + 1) / e;
    const double shift = size[k] * (to3 + to4) / (e * e), share3 = std::abs(b[k]),
                 share4 = std::abs(1 - b[k]);
    rows[k] = size[k] * size[k] + g3 + g4;
    rows[2] += g4 + share3 * (g3 + g4) + shift;
    rows[3] += g3 + share4 * (g3 + g4) + shift;
  }
  return rows;
}

}  // namespace

void Bending::add_stiffness_bound(const State& s, PerParticle& rows) const {
  // One hinge's stiffness matrix is ke c (magnitude' u u^T - magnitude grad u). A row of the first sums to
  // |u_i| sum |u_j|; the second counts where a hinge is far from its rest angle. With current weighting the
  // change of c itself is left out.
  const BendingLaw& law = bending_law(material.law);
  for (const BendingHinge& hinge : hinges) {
    const HingeShape shape = checked_shape_of(hinge, s.x);
    const double theta = angle_of(shape),
                 weight = material.stiffness * weight_of(hinge, shape, material.weighting);
    const double slope = std::abs(law.slope(theta, hinge.rest_angle)),
                 magnitude = std::abs(law.magnitude(theta, hinge.rest_angle));
    const Eigen::Vector4d norms = bending_mode(shape).colwise().norm();
    const Eigen::Vector4d sums =
        slope * norms.sum() * norms + magnitude * mode_gradient_rows(shape, hinge.particles, s.x);
    for (int k = 0; k < 4; ++k) rows[hinge.particles[size_t(k)]] += weight * sums[k];
  }
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

  Bending bending{material, {}};
  bending.hinges.reserve(mesh.hinges.size());
  for (size_t h = 0; h < mesh.hinges.size(); ++h) {
    const double theta0 = rest_angles[h];
    if (!(std::abs(theta0) <= pi)) throw InputError("bending: rest angles must lie in [-pi, pi] rad");
    BendingHinge hinge{mesh.hinges[h].particles, 0, theta0, std::sin(theta0 / 2)};
    const HingeShape shape = checked_shape_of(hinge, mesh.rest);
    hinge.rest_weight = shape.edge * shape.edge / shape.area_sum;
    bending.hinges.push_back(hinge);
  }
  return bending;
}

}  // namespace foldproof
