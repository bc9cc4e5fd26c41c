#include "verification/subjects/reference_subject.h"

#include <algorithm>
#include <vector>

#include "reference/dynamics/integrator.h"
#include "reference/forces/force.h"

namespace foldproof {

namespace {

struct PreparedReference : Prepared {
  System system;
  const Integrator& integrator;

  explicit PreparedReference(const Scene& scene)
      : system(build_system(scene)), integrator(integrator_named(scene.integrator)) {}
};

const PreparedReference& own(const Prepared& prepared) {
  return static_cast<const PreparedReference&>(prepared);
}

/// v as the filters of this kind make it.
template <class Kind>
PerParticle3 filtered(const Prepared& prepared, const Span& span, const State& s, PerParticle3 v) {
  Work uncounted;
  for (const Filter& filter : own(prepared).system.filters)
    if (const auto* of_kind = std::get_if<Kind>(&filter)) of_kind->correct(span, s, v, uncounted);
  return v;
}

/// Is there anything that forms or breaks?
bool sticks(const System& system) {
  return std::ranges::any_of(system.forces,
                             [](const Force& force) { return std::holds_alternative<Sticking>(force); });
}

}  // namespace

Subject reference_subject() {
  Subject subject;
  subject.name = "foldproof reference";
  subject.version = "0.2.0";
  subject.prepare = [](const Scene& scene) { return std::make_unique<PreparedReference>(scene); };
  subject.elastic_forces = [](Prepared& prepared, const State& s) {
    Work uncounted;
    return elastic_forces(own(prepared).system.forces, s, uncounted);
  };
  subject.damping_forces = [](Prepared& prepared, const State& s, const PerParticle3& v) {
    Work uncounted;
    PerParticle3 force = PerParticle3::Zero(3, s.x.cols());
    damping_at(own(prepared).system.forces, s, uncounted).add_product(v, force);
    return force;
  };
  subject.potential_energy = [](Prepared& prepared, const State& s) {
    const Energies e = energies(own(prepared).system, s);
    return e.total() - e.kinetic;
  };
  subject.avoid_objects = filtered<ObjectCollision>;
  subject.limit_strain = filtered<StrainLimiter>;
  subject.avoid_itself = filtered<SelfCollision>;
  subject.step = [](Prepared& prepared, std::span<const State> past, double dt, Work& work) {
    const PreparedReference& reference = own(prepared);
    if (!sticks(reference.system)) return reference.integrator.step(reference.system, past, dt, work);
    std::vector<State> begun(past.begin(), past.end());
    begin_step(reference.system, begun.back());
    work.bonds += long(begun.back().bonds.size());
    return reference.integrator.step(reference.system, begun, dt, work);
  };
  return subject;
}

}  // namespace foldproof
