// Bounds on the elastic stiffness and on the damping rate, from which the stable step follows.
#include <algorithm>
#include <cmath>

#include "reference/forces/force.h"

namespace foldproof {

namespace {

/// Bounds on the rows of grad u, for each particle i the sum over j of |du_i/dx_j| [1/m^2]. With
/// l_km the distance from x_k to x_m, e = |E|, and d(N/|N|^2) = dN/|N|^2 in size, u_k = |E|
/// N_k/|N_k|^2 gives for k = 1, 2
///   |du_k/dx_k| = |u_k|^2,   |du_k/dx_3| <= g_k4,   |du_k/dx_4| <= g_k3,
///   g_km = |u_k|^2 l_km/e + |u_k|/e,
/// the same for du_3/dx_k and du_4/dx_k since grad u is symmetric, and, with |db_k/dx_3| = l_k4/e^2
/// and |db_k/dx_4| = l_k3/e^2, the rest from u_3 = -(b_1 u_1 + b_2 u_2) and u_4 = -((1 - b_1) u_1 +
/// (1 - b_2) u_2).
///   size   |u_1|, |u_2| [1/m]
Eigen::Vector4d mode_gradient_rows(const HingeShape& shape, const Eigen::Array2d& size,
                                   const std::array<int, 4>& particles, const PerParticle3& x) {
  const Vector3 x1 = x.col(particles[0]), x2 = x.col(particles[1]), x3 = x.col(particles[2]),
                x4 = x.col(particles[3]);
  const double e = shape.edge;
  // of k = 1, 2
  const Eigen::Array2d b(shape.b1, shape.b2);
  const Eigen::Array2d to3 =
                           Eigen::Array2d((x1 - x3).squaredNorm(), (x2 - x3).squaredNorm()).sqrt(),
                       to4 =
                           Eigen::Array2d((x1 - x4).squaredNorm(), (x2 - x4).squaredNorm()).sqrt();
  const Eigen::Array2d g3 = size * (size * to3 + 1) / e, g4 = size * (size * to4 + 1) / e;
  const Eigen::Array2d shift = size * (to3 + to4) / (e * e);
  const Eigen::Array2d own = size * size + g3 + g4, of3 = g4 + b.abs() * (g3 + g4) + shift,
                       of4 = g3 + (1 - b).abs() * (g3 + g4) + shift;
  return {own[0], own[1], of3[0] + of3[1], of4[0] + of4[1]};
}

/// The size of the law's slope; the paper's law needs no angle.
double slope_size(const BendingLaw& law, const BendingHinge& hinge, const HingeShape& shape) {
  return law.name == "sine" ? 0.5 * std::sqrt(std::max(0.0, 1 - shape.sin_half * shape.sin_half))
                            : std::abs(law.slope(shape.angle(), hinge.rest_angle));
}

/// The largest row over its particle's mass; NaN if any is.
double largest_over_mass(const PerParticle& rows, const PerParticle& inverse_mass) {
  double largest = 0;
  for (const double one : rows.cwiseProduct(inverse_mass).eval()) update_worst(largest, one);
  return largest;
}

}  // namespace

void StretchSprings::add_stiffness_bound(const State&, const SpringShapes& shapes,
                                         PerParticle& rows) const {
  // One spring's stiffness matrix is k along d and tension/|d| across it; a row of it sums to at
  // most twice the larger.
  springs.push(shapes, rows, [](const Spring& spring, const SpringShape& shape, const auto& to) {
    const double across =
        spring.stiffness * std::abs(shape.length - spring.rest_length) / shape.length;
    const double row = 2 * std::max(spring.stiffness, across);
    to.add(spring.a, row);
    to.add(spring.b, row);
  });
}

void Bending::add_stiffness_bound(const State& s, const HingeShapes& shapes,
                                  PerParticle& rows) const {
  // One hinge's stiffness matrix is ke c (magnitude' u u^T - magnitude grad u). A row of the first
  // sums to |u_i| sum |u_j|; the second counts where a hinge is far from its rest angle. With
  // current weighting the change of c itself is left out.
  const BendingLaw& law = bending_law(material.law);
  hinges.push(
      shapes, rows, [&](const BendingHinge& hinge, const HingeShape& shape, const auto& to) {
        const double weight = material.stiffness * weight_of(hinge, shape, material.weighting);
        const double slope = slope_size(law, hinge, shape),
                     magnitude = std::abs(magnitude_of(law, hinge, shape));
        const Eigen::Vector4d squares = bending_mode(shape).colwise().squaredNorm();
        const Eigen::Vector4d norms = squares.cwiseSqrt();
        const Eigen::Vector4d sums =
            slope * norms.sum() * norms +
            magnitude * mode_gradient_rows(shape, norms.head<2>().array(), hinge.particles, s.x);
        for (int k = 0; k < 4; ++k) to.add(hinge.particles[size_t(k)], weight * sums[k]);
      });
}

double damping_rate_bound(const DampingOperator& damping, const PerParticle& inverse_mass) {
  PerParticle rows = PerParticle::Zero(inverse_mass.size());
  for (const PairDamper& p : damping.pairs) {
    rows[p.a] += 2 * p.along.squaredNorm();
    rows[p.b] += 2 * p.along.squaredNorm();
  }
  for (const HingeDamper& h : damping.hinges) {
    const Vector3 w3 = -(h.weight1 * h.w1 + h.weight2 * h.w2), w4 = -(h.w1 + h.w2 + w3);
    const Eigen::Vector4d norms(h.w1.norm(), h.w2.norm(), w3.norm(), w4.norm());
    for (int k = 0; k < 4; ++k) rows[h.particles[size_t(k)]] += norms[k] * norms.sum();
  }
  for (const TargetDamper& t : damping.targets)
    add_row_sums(t.particle, t.frames, t.coefficient, rows);
  for (const DampingOperator::Custom& one : damping.custom)
    if (one.add_rows) one.add_rows(rows);
  return largest_over_mass(rows, inverse_mass);
}

PerParticle stiffness_row_bounds(const std::vector<Force>& forces, const State& s,
                                 StickingPart part, const Work& work) {
  PerParticle rows = PerParticle::Zero(s.x.cols());
  for_each_force(forces, s, *shapes_at(forces, s.x, work),
                 [&](const auto& force, const auto&... at) {
                   if constexpr (requires { force.add_bound_without_springs(at..., rows); })
                     if (part == StickingPart::without_springs)
                       return force.add_bound_without_springs(at..., rows);
                   if constexpr (requires { force.add_stiffness_bound(at..., rows); })
                     force.add_stiffness_bound(at..., rows);
                 });
  return rows;
}

double frequency_bound(const std::vector<Force>& forces, const State& s,
                       const PerParticle& inverse_mass, const Work& work) {
  return std::sqrt(
      largest_over_mass(stiffness_row_bounds(forces, s, StickingPart::all, work), inverse_mass));
}

double frequency_without_sticking_springs(const std::vector<Force>& forces, const State& s,
                                          const PerParticle& inverse_mass, const Work& work) {
  return std::sqrt(largest_over_mass(
      stiffness_row_bounds(forces, s, StickingPart::without_springs, work), inverse_mass));
}

}  // namespace foldproof
