#include "reference/forces/bending.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "reference/forces/degenerate.h"

namespace foldproof {

namespace {

// Squared height over edge below which a triangle counts as degenerate: at 1e-10 of the edge
// rounding has eaten the normal.
constexpr double smallest_height_squared = 1e-20;

template <class Own>
void add_forces(const std::array<int, 4>& particles, const HingeShape& shape, double magnitude,
                const Own& own, PerParticle3& f) {
  const Vector3 f1 = magnitude * shape.u1, f2 = magnitude * shape.u2;
  const Vector3 f3 = -(shape.b1 * f1 + shape.b2 * f2);
  if (own.has(particles[0])) f.col(particles[0]) += f1;
  if (own.has(particles[1])) f.col(particles[1]) += f2;
  if (own.has(particles[2])) f.col(particles[2]) += f3;
  if (own.has(particles[3])) f.col(particles[3]) -= f1 + f2 + f3;
}

double sine_magnitude(double theta, double rest_angle) {
  return std::sin(theta / 2) - std::sin(rest_angle / 2);
}

double sine_slope(double theta, double) { return 0.5 * std::cos(theta / 2); }

double sine_potential(double theta, double rest_angle) {
  // 2 (cos(theta0/2) - cos(theta/2)) as a product of sines, which loses no digits near a rest angle
  // of 0; near others a share of about tan(theta0/2)/(theta - theta0) of a rounding
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
  shape.sin_half = cosine >= 0 ? sine / std::sqrt(2 + 2 * cosine)
                               : std::copysign(std::sqrt(0.5 - 0.5 * cosine), sine + 0.0);
  return shape;
}

double hinge_angle(const Vector3& x1, const Vector3& x2, const Vector3& x3, const Vector3& x4) {
  const Vector3 E = x4 - x3, N1 = (x1 - x3).cross(x1 - x4), N2 = (x2 - x4).cross(x2 - x3);
  const double sine = N1.dot(x3 - x2) * E.norm();
  return std::atan2(sine + 0.0, N1.dot(N2));  // + 0: a sine of -0 counts as positive, too
}

HingeShape checked_hinge_shape(const BendingHinge& hinge, const PerParticle3& x) {
  const auto [i1, i2, i3, i4] = hinge.particles;
  const HingeShape shape = hinge_shape(x.col(i1), x.col(i2), x.col(i3), x.col(i4));
  if (shape.degenerate)
    throw DegenerateElement("a triangle of a hinge has lost its area", {i1, i2, i3, i4});
  return shape;
}

double angle_of(const BendingHinge& hinge, const PerParticle3& x) {
  const auto [i1, i2, i3, i4] = hinge.particles;
  return hinge_angle(x.col(i1), x.col(i2), x.col(i3), x.col(i4));
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

void Bending::use_threads(int threads, Eigen::Index particles) {
  std::vector<std::array<int, 4>> corners;
  for (const BendingHinge& hinge : hinges) corners.push_back(hinge.particles);
  sharing = share_out(threads, particles, corners);
}

void Bending::add_elastic(const State& s, PerParticle3& f) const {
  const BendingLaw& law = bending_law(material.law);
  const bool is_sine = law.magnitude == sine_magnitude;  // needs no angle, only its sine
  for_each_run(sharing, hinges, [&](auto part, const auto& own) {
    for (const BendingHinge& hinge : part) {
      const HingeShape shape = checked_hinge_shape(hinge, s.x);
      const double magnitude = is_sine ? shape.sin_half - hinge.sin_half_rest
                                       : law.magnitude(angle_of(hinge, s.x), hinge.rest_angle);
      add_forces(hinge.particles, shape,
                 material.stiffness * weight_of(hinge, shape, material.weighting) * magnitude, own,
                 f);
    }
  });
}

double Bending::energy(const State& s) const {
  const BendingLaw& law = bending_law(material.law);
  const double sum = sum_over(threads_of(sharing), hinges, [&](const BendingHinge& hinge) {
    const HingeShape shape = checked_hinge_shape(hinge, s.x);
    return weight_of(hinge, shape, material.weighting) *
           law.potential(angle_of(hinge, s.x), hinge.rest_angle);
  });
  return material.stiffness * sum;
}

void Bending::prepare_damping(const State& s, DampingOperator& damping) const {
  if (material.damping == 0) return;
  HingeDamper* const dampers = damping.add_hinges(hinges.size(), sharing);
  for_each_range(threads_of(sharing), hinges, [&](auto part, size_t first) {
    HingeDamper* to = dampers + first;
    for (const BendingHinge& hinge : part) {
      const HingeShape shape = checked_hinge_shape(hinge, s.x);
      const double factor = material.damping_factor == DampingFactor::edge
                                ? shape.edge
                                : shape.edge * shape.edge / shape.area_sum;
      const double root = std::sqrt(material.damping * factor);
      *to++ = {hinge.particles, shape.b1, shape.b2, root * shape.u1, root * shape.u2};
    }
  });
}

namespace {

/// Bounds on the rows of grad u, for each particle i the sum over j of |du_i/dx_j| [1/m^2]. With
/// l_km the distance from x_k to x_m, e = |E|, and d(N/|N|^2) = dN/|N|^2 in size, u_k = |E|
/// N_k/|N_k|^2 gives for k =
/// 1, 2
///   |du_k/dx_k| = |u_k|^2,   |du_k/dx_3| <= g_k4,   |du_k/dx_4| <= g_k3,
///   g_km = |u_k|^2 l_km/e + |u_k|/e,
/// the same for du_3/dx_k and du_4/dx_k since grad u is symmetric, and, with |db_k/dx_3| = l_k4/e^2
/// and |db_k/dx_4| = l_k3/e^2, the rest from u_3 = -(b_1 u_1 + b_2 u_2) and u_4 = -((1 - b_1) u_1 +
/// (1 - b_2) u_2).
Eigen::Vector4d mode_gradient_rows(const HingeShape& shape, const std::array<int, 4>& particles,
                                   const PerParticle3& x) {
  const Vector3 x3 = x.col(particles[2]), x4 = x.col(particles[3]);
  const double e = shape.edge, size[2] = {shape.u1.norm(), shape.u2.norm()},
               b[2] = {shape.b1, shape.b2};
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
  // One hinge's stiffness matrix is ke c (magnitude' u u^T - magnitude grad u). A row of the first
  // sums to |u_i| sum |u_j|; the second counts where a hinge is far from its rest angle. With
  // current weighting the change of c itself is left out.
  const BendingLaw& law = bending_law(material.law);
  const bool is_sine = law.magnitude == sine_magnitude;  // needs no angle, only its sine
  for_each_run(sharing, hinges, [&](auto part, const auto& own) {
    for (const BendingHinge& hinge : part) {
      const HingeShape shape = checked_hinge_shape(hinge, s.x);
      const double weight = material.stiffness * weight_of(hinge, shape, material.weighting);
      const double theta = is_sine ? 0 : angle_of(hinge, s.x);
      const double slope = is_sine
                               ? 0.5 * std::sqrt(std::max(0.0, 1 - shape.sin_half * shape.sin_half))
                               : std::abs(law.slope(theta, hinge.rest_angle));
      const double magnitude = std::abs(is_sine ? shape.sin_half - hinge.sin_half_rest
                                                : law.magnitude(theta, hinge.rest_angle));
      const Eigen::Vector4d norms = bending_mode(shape).colwise().norm();
      const Eigen::Vector4d sums =
          slope * norms.sum() * norms + magnitude * mode_gradient_rows(shape, hinge.particles, s.x);
      for (int k = 0; k < 4; ++k)
        if (const int i = hinge.particles[size_t(k)]; own.has(i)) rows[i] += weight * sums[k];
    }
  });
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
    if (!(std::abs(theta0) <= pi))
      throw InputError("bending: rest angles must lie in [-pi, pi] rad");
    BendingHinge hinge{mesh.hinges[h].particles, 0, theta0, std::sin(theta0 / 2)};
    const HingeShape shape = checked_hinge_shape(hinge, mesh.rest);
    hinge.rest_weight = shape.edge * shape.edge / shape.area_sum;
    bending.hinges.push_back(hinge);
  }
  return bending;
}

}  // namespace foldproof
