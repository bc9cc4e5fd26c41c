#include "verification/subjects/reference_subject.h"

#include <algorithm>
#include <vector>

#include "reference/dynamics/integrator.h"
#include "reference/forces/force.h"

namespace foldproof {

namespace {

struct PreparedReferenceScene : PreparedScene {
  System system;
  const Integrator& integrator;

  explicit PreparedReferenceScene(const Scene& scene)
      : system(build_system(scene)), integrator(integrator_named(scene.integrator)) {}
};

const PreparedReferenceScene& own(const PreparedScene& prepared) {
  return static_cast<const PreparedReferenceScene&>(prepared);
}

/// v as the filters of this kind make it.
template <class Kind>
PerParticle3 filter_velocity(const PreparedScene& prepared, const Span& span, const State& s,
                             PerParticle3 v) {
  Work uncounted;
  for (const Filter& filter : own(prepared).system.filters)
    if (const auto* of_kind = std::get_if<Kind>(&filter)) of_kind->correct(span, s, v, uncounted);
  return v;
}

/// Is there anything that forms or breaks?
bool sticks(const System& system) {
  return std::ranges::any_of(
      system.forces, [](const Force& force) { return std::holds_alternative<Sticking>(force); });
}

}  // namespace

void set_masses(PreparedScene& prepared, const PerParticle& masses) {
  System& system = static_cast<PreparedReferenceScene&>(prepared).system;
  for (Eigen::Index i = 0; i < masses.size(); ++i)
    if (system.inverse_mass[i] > 0) system.inverse_mass[i] = 1 / masses[i];
  system.mass = masses;
  for (Force& force : system.forces)
    if (auto* weight = std::get_if<Gravity>(&force)) weight->mass = masses;
  for (Filter& filter : system.filters) {
    if (auto* layers = std::get_if<SelfCollision>(&filter))
      layers->mass = masses, layers->inverse_mass = system.inverse_mass;
    if (auto* limiter = std::get_if<StrainLimiter>(&filter))
      limiter->inverse_mass = system.inverse_mass;
  }
}

std::vector<PrescribedParticle>& prescribed_of(PreparedScene& prepared) {
  return static_cast<PreparedReferenceScene&>(prepared).system.prescribed;
}

Subject reference_subject() {
  Subject subject;
  subject.name = "foldproof reference";
  subject.version = "0.2.0";
  subject.prepare = [](const Scene& scene) {
    return std::make_unique<PreparedReferenceScene>(scene);
  };
  subject.elastic_forces = [](PreparedScene& prepared, const State& s) {
    Work uncounted;
    return elastic_forces(own(prepared).system.forces, s, uncounted);
  };
  subject.damping_forces = [](PreparedScene& prepared, const State& s, const PerParticle3& v) {
    Work uncounted;
    PerParticle3 force = PerParticle3::Zero(3, s.x.cols());
    damping_at(own(prepared).system.forces, s, uncounted)->add_product(v, force);
    return force;
  };
  subject.potential_energy = [](PreparedScene& prepared, const State& s) {
    const Energies e = energies(own(prepared).system, s);
    return e.total() - e.kinetic;
  };
  subject.avoid_objects = filter_velocity<ObjectCollision>;
  subject.limit_strain = filter_velocity<StrainLimiter>;
  subject.avoid_itself = filter_velocity<SelfCollision>;
  subject.step = [](PreparedScene& prepared, std::span<const State> past, double dt, Work& work) {
    const PreparedReferenceScene& reference = own(prepared);
    if (!sticks(reference.system))
      return reference.integrator.step(reference.system, past, dt, work);
    std::vector<State> begun(past.begin(), past.end());
    begin_step(reference.system, begun.back());
    work.bonds += long(begun.back().bonds.size());
    return reference.integrator.step(reference.system, begun, dt, work);
  };
  return subject;
}

}  // namespace foldproof
