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
    if (const auto* custom = std::get_if<CustomForce>(&force)) prepare(*custom, s, damping);
  }
  ++work.damping_preparations;
  return damping;
}

double frequency_bound(const std::vector<Force>& forces, const State& s, const PerParticle& inverse_mass) {
  PerParticle rows = PerParticle::Zero(s.x.cols());
  for (const Force& force : forces) {
    if (const auto* springs = std::get_if<StretchSprings>(&force)) springs->add_stiffness_bound(s, rows);
    if (const auto* bending = std::get_if<Bending>(&force)) bending->add_stiffness_bound(s, rows);
  }
  double largest = 0;
  for (Eigen::Index i = 0; i < rows.size(); ++i) keep_worst(largest, rows[i] * inverse_mass[i]);
  return std::sqrt(largest);
}

}  // namespace foldproof
