#include "reference/forces/force.h"

#include <cmath>

namespace foldproof {

PerParticle3 elastic_forces(const std::vector<Force>& forces, const State& s, Work& work) {
  PerParticle3 f = PerParticle3::Zero(3, s.x.cols());
  for (const Force& force : forces) std::visit([&](const auto& part) { part.add_elastic(s, f); }, force);
  ++work.elastic_evaluations;
  return f;
}

namespace {

void prepare(const CustomForce& force, const State& s, DampingOperator& damping) {
  if (!force.damping) return;
  damping.custom.push_back([&force, s](const PerParticle3& v, PerParticle3& f) { force.damping(s, v, f); });
}

}  // namespace

DampingOperator damping_at(const std::vector<Force>& forces, const State& s, Work& work) {
  DampingOperator damping;
  for (const Force& force : forces) {
    if (const auto* springs = std::get_if<StretchSprings>(&force)) springs->prepare_damping(s, damping);
    if (const auto* bending = std::get_if<Bending>(&force)) bending->prepare_damping(s, damping);
    if (const auto* sticking = std::get_if<Sticking>(&force)) sticking->prepare_damping(s, damping);
    if (const auto* custom = std::get_if<CustomForce>(&force)) prepare(*custom, s, damping);
  }
  ++work.damping_preparations;
  return damping;
}

namespace {

void add_differential(const CustomForce& force, const State& s, ForceDifferential& differential) {
  if (!force.differential) return;
  differential.custom.push_back(
      [&force, s](const PerParticle3& dx, PerParticle3& df) { force.differential(s, dx, df); });
}

}  // namespace

ForceDifferential elastic_differential_at(const std::vector<Force>& forces, const State& s,
                                          Definiteness definiteness, Work& work) {
  ForceDifferential differential;
  for (const Force& force : forces) {
    if (const auto* springs = std::get_if<StretchSprings>(&force))
      springs->add_elastic_differential(s, definiteness, differential);
    if (const auto* bending = std::get_if<Bending>(&force))
      bending->add_elastic_differential(s, definiteness, differential);
    if (const auto* sticking = std::get_if<Sticking>(&force))
      sticking->add_elastic_differential(s, definiteness, differential);
    if (const auto* custom = std::get_if<CustomForce>(&force)) add_differential(*custom, s, differential);
  }
  ++work.stiffness_preparations;
  return differential;
}

ForceDifferential force_differential_at(const std::vector<Force>& forces, const State& s, Work& work) {
  ForceDifferential differential;
  for (const Force& force : forces) {
    if (const auto* springs = std::get_if<StretchSprings>(&force))
      springs->add_force_differential(s, differential);
    if (const auto* bending = std::get_if<Bending>(&force)) bending->add_force_differential(s, differential);
    if (const auto* sticking = std::get_if<Sticking>(&force))
      sticking->add_force_differential(s, differential);
    if (const auto* custom = std::get_if<CustomForce>(&force)) add_differential(*custom, s, differential);
  }
  ++work.stiffness_preparations;
  return differential;
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
  for (const TargetDamper& t : damping.targets) add_row_sums(t.particle, t.frames, t.coefficient, rows);
  double largest = 0;
  for (Eigen::Index i = 0; i < rows.size(); ++i) keep_worst(largest, rows[i] * inverse_mass[i]);
  return largest;
}

namespace {

double frequency_of(const PerParticle& rows, const PerParticle& inverse_mass) {
  double largest = 0;
  for (Eigen::Index i = 0; i < rows.size(); ++i) keep_worst(largest, rows[i] * inverse_mass[i]);
  return std::sqrt(largest);
}

}  // namespace

PerParticle stiffness_row_bounds(const std::vector<Force>& forces, const State& s, StickingPart part) {
  PerParticle rows = PerParticle::Zero(s.x.cols());
  for (const Force& force : forces) {
    if (const auto* springs = std::get_if<StretchSprings>(&force)) springs->add_stiffness_bound(s, rows);
    if (const auto* bending = std::get_if<Bending>(&force)) bending->add_stiffness_bound(s, rows);
    if (const auto* sticking = std::get_if<Sticking>(&force)) {
      if (part == StickingPart::all) sticking->add_spring_bound(s, rows);
      sticking->add_turning_bound(s, rows);
    }
  }
  return rows;
}

double frequency_bound(const std::vector<Force>& forces, const State& s, const PerParticle& inverse_mass) {
  return frequency_of(stiffness_row_bounds(forces, s, StickingPart::all), inverse_mass);
}

double frequency_beyond_forecasts(const std::vector<Force>& forces, const State& s,
                                  const PerParticle& inverse_mass) {
  return frequency_of(stiffness_row_bounds(forces, s, StickingPart::beyond_forecasts), inverse_mass);
}

}  // namespace foldproof
