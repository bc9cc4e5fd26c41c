#include "reference/forces/force.h"

#include <cmath>

namespace foldproof {

PerParticle3 elastic_forces(const std::vector<Force>& forces, const State& s, Work& work) {
  PerParticle3 f = PerParticle3::Zero(3, s.x.cols());
  for_each_force(forces, [&](const auto& force) { force.add_elastic(s, f); });
  ++work.elastic_evaluations;
  return f;
}

void CustomForce::prepare_damping(const State& s, DampingOperator& terms) const {
  if (!damping) return;
  terms.custom.push_back([this, s](const PerParticle3& v, PerParticle3& f) { damping(s, v, f); });
}

void CustomForce::add_elastic_differential(const State& s, Definiteness,
                                           ForceDifferential& sum) const {
  if (!differential) return;
  sum.custom.push_back(
      [this, s](const PerParticle3& dx, PerParticle3& df) { differential(s, dx, df); });
}

void CustomForce::add_force_differential(const State& s, ForceDifferential& sum) const {
  add_elastic_differential(s, Definiteness::exact, sum);
}

DampingOperator damping_at(const std::vector<Force>& forces, const State& s, Work& work) {
  DampingOperator damping;
  for_each_force(forces, [&](const auto& force) {
    if constexpr (requires { force.prepare_damping(s, damping); })
      force.prepare_damping(s, damping);
  });
  ++work.damping_preparations;
  return damping;
}

ForceDifferential elastic_differential_at(const std::vector<Force>& forces, const State& s,
                                          Definiteness definiteness, Work& work) {
  ForceDifferential differential;
  for_each_force(forces, [&](const auto& force) {
    if constexpr (requires { force.add_elastic_differential(s, definiteness, differential); })
      force.add_elastic_differential(s, definiteness, differential);
  });
  ++work.stiffness_preparations;
  return differential;
}

ForceDifferential force_differential_at(const std::vector<Force>& forces, const State& s,
                                        Work& work) {
  ForceDifferential differential;
  for_each_force(forces, [&](const auto& force) {
    if constexpr (requires { force.add_force_differential(s, differential); })
      force.add_force_differential(s, differential);
  });
  ++work.stiffness_preparations;
  return differential;
}

namespace {

/// The largest row over its particle's mass; NaN if any is.
double largest_over_mass(const PerParticle& rows, const PerParticle& inverse_mass) {
  double largest = 0;
  for (const double one : rows.cwiseProduct(inverse_mass).eval()) update_worst(largest, one);
  return largest;
}

}  // namespace

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
  return largest_over_mass(rows, inverse_mass);
}

PerParticle stiffness_row_bounds(const std::vector<Force>& forces, const State& s,
                                 StickingPart part) {
  PerParticle rows = PerParticle::Zero(s.x.cols());
  for_each_force(forces, [&](const auto& force) {
    if constexpr (requires { force.add_bound_without_springs(s, rows); })
      if (part == StickingPart::without_springs) return force.add_bound_without_springs(s, rows);
    if constexpr (requires { force.add_stiffness_bound(s, rows); })
      force.add_stiffness_bound(s, rows);
  });
  return rows;
}

double frequency_bound(const std::vector<Force>& forces, const State& s,
                       const PerParticle& inverse_mass) {
  return std::sqrt(
      largest_over_mass(stiffness_row_bounds(forces, s, StickingPart::all), inverse_mass));
}

double frequency_without_sticking_springs(const std::vector<Force>& forces, const State& s,
                                          const PerParticle& inverse_mass) {
  return std::sqrt(largest_over_mass(stiffness_row_bounds(forces, s, StickingPart::without_springs),
                                     inverse_mass));
}

}  // namespace foldproof
