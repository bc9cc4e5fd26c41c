#include "reference/forces/force.h"

#include <algorithm>
#include <cstring>

#include "reference/fast/kept_values.h"

namespace foldproof {

void CustomForce::prepare_damping(const State& s, DampingOperator& terms) const {
  if (damping) terms.custom.push_back(damping(s));
}

void CustomForce::add_elastic_differential(const State& s, Definiteness definiteness,
                                           ForceDifferential& sum) const {
  if (differential) sum.custom.push_back(differential(s, definiteness));
}

void CustomForce::add_force_differential(const State& s, ForceDifferential& sum) const {
  add_elastic_differential(s, Definiteness::exact, sum);
}

namespace {

/// The latest values of a run, and their inputs.
struct LatestForces {
  PerParticle3 x;  // m
  std::shared_ptr<const Shapes> shapes = {};
  double time = 0;  // s
  std::vector<Bond> bonds = {};
  Forces forces = {};  // each null until first used
  ForceCounts computed = {};
};

/// Equal to the last bit, NaN included.
bool are_identical(const PerParticle3& a, const PerParticle3& b) {
  return a.cols() == b.cols() &&
         std::memcmp(a.data(), b.data(), sizeof(double) * size_t(a.size())) == 0;
}

bool are_identical(const Bond& a, const Bond& b) {
  return a.patch == b.patch && a.triangle == b.triangle && a.particle == b.particle &&
         a.place == b.place;
}

bool are_identical(const std::vector<Bond>& a, const std::vector<Bond>& b) {
  return std::ranges::equal(
      a, b, [](const Bond& one, const Bond& other) { return are_identical(one, other); });
}

bool needs_velocity(const Force& force) {
  const auto* const custom = std::get_if<CustomForce>(&force);
  return custom && custom->needs_velocity;
}

Shapes computed_shapes(const std::vector<Force>& forces, const PerParticle3& x) {
  Shapes shapes(forces.size());
  for (size_t k = 0; k < forces.size(); ++k)
    std::visit(
        [&](const auto& force) {
          if constexpr (requires { force.shapes_at(x); }) shapes[k] = force.shapes_at(x);
        },
        forces[k]);
  return shapes;
}

PerParticle3 computed_elastic(const std::vector<Force>& forces, const State& s,
                              const Shapes& shapes) {
  PerParticle3 f = PerParticle3::Zero(3, s.x.cols());
  for_each_force(forces, s, shapes,
                 [&](const auto& force, const auto&... at) { force.add_elastic(at..., f); });
  return f;
}

DampingOperator computed_damping(const std::vector<Force>& forces, const State& s,
                                 const Shapes& shapes) {
  DampingOperator damping;
  for_each_force(forces, s, shapes, [&](const auto& force, const auto&... at) {
    if constexpr (requires { force.prepare_damping(at..., damping); })
      force.prepare_damping(at..., damping);
  });
  return damping;
}

/// Updates the shapes to x.
void update(const std::vector<Force>& forces, const PerParticle3& x, LatestForces& latest) {
  if (latest.shapes && are_identical(latest.x, x)) return;
  latest.shapes = nullptr;
  latest.forces = {};
  latest.shapes = std::make_shared<const Shapes>(computed_shapes(forces, x));
  latest.x = x;
  ++latest.computed.shapes;
}

/// Discards the forces unless they were computed at s.
void update(const std::vector<Force>& forces, const State& s, LatestForces& latest) {
  update(forces, s.x, latest);
  if (latest.time != s.time || !are_identical(latest.bonds, s.bonds) ||
      std::ranges::any_of(forces, needs_velocity))
    latest.forces = {};
  latest.time = s.time;
  latest.bonds = s.bonds;
}

/// The values that the run keeps, or `unkept` if it keeps none, updated to s (a state or its x).
template <class Where>
LatestForces& latest_at(const std::vector<Force>& forces, const Where& s, const Work& work,
                        LatestForces& unkept) {
  LatestForces& latest = work.kept ? work.kept->of<LatestForces>(forces) : unkept;
  update(forces, s, latest);
  return latest;
}

const std::shared_ptr<const PerParticle3>& elastic(const std::vector<Force>& forces, const State& s,
                                                   LatestForces& latest, Work& work) {
  ++work.elastic_evaluations;
  if (latest.forces.elastic) return latest.forces.elastic;
  ++latest.computed.elastic;
  return latest.forces.elastic =
             std::make_shared<const PerParticle3>(computed_elastic(forces, s, *latest.shapes));
}

const std::shared_ptr<const DampingOperator>& damping(const std::vector<Force>& forces,
                                                      const State& s, LatestForces& latest,
                                                      Work& work) {
  ++work.damping_preparations;
  if (latest.forces.damping) return latest.forces.damping;
  ++latest.computed.damping;
  return latest.forces.damping =
             std::make_shared<const DampingOperator>(computed_damping(forces, s, *latest.shapes));
}

}  // namespace

std::shared_ptr<const Shapes> shapes_at(const std::vector<Force>& forces, const PerParticle3& x,
                                        const Work& work) {
  LatestForces unkept;
  return latest_at(forces, x, work, unkept).shapes;
}

PerParticle3 elastic_forces(const std::vector<Force>& forces, const State& s, Work& work) {
  LatestForces unkept;
  return *elastic(forces, s, latest_at(forces, s, work, unkept), work);
}

std::shared_ptr<const DampingOperator> damping_at(const std::vector<Force>& forces, const State& s,
                                                  Work& work) {
  LatestForces unkept;
  return damping(forces, s, latest_at(forces, s, work, unkept), work);
}

Forces forces_at(const std::vector<Force>& forces, const State& s, Work& work) {
  LatestForces unkept;
  LatestForces& latest = latest_at(forces, s, work, unkept);
  return {elastic(forces, s, latest, work), damping(forces, s, latest, work)};
}

ForceCounts computed_in_run(const std::vector<Force>& forces, const Work& work) {
  return work.kept ? work.kept->of<LatestForces>(forces).computed : ForceCounts{};
}

ForceDifferential elastic_differential_at(const std::vector<Force>& forces, const State& s,
                                          Definiteness definiteness, Work& work) {
  ForceDifferential differential;
  for (const Force& force : forces)
    std::visit(
        [&](const auto& of) {
          if constexpr (requires { of.add_elastic_differential(s, definiteness, differential); })
            of.add_elastic_differential(s, definiteness, differential);
        },
        force);
  ++work.stiffness_preparations;
  return differential;
}

ForceDifferential force_differential_at(const std::vector<Force>& forces, const State& s,
                                        Work& work) {
  ForceDifferential differential;
  for (const Force& force : forces)
    std::visit(
        [&](const auto& of) {
          if constexpr (requires { of.add_force_differential(s, differential); })
            of.add_force_differential(s, differential);
        },
        force);
  ++work.stiffness_preparations;
  return differential;
}

}  // namespace foldproof
