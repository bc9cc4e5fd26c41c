#include "verification/subjects/reference_subject.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "reference/dynamics/integrator.h"
#include "reference/dynamics/mixed.h"
#include "reference/forces/force.h"

namespace foldproof {

namespace {

struct PreparedReferenceScene : PreparedScene {
  System system;
  const Integrator& integrator;
  PerParticle3 unmodified;  // velocities that the objects are given [m/s], 3 x N
  PerParticle3 impulses;    // of the objects since they were taken [N s], 3 x N
  double lasting = 1;       // change of the velocity that a change in this step leads to

  explicit PreparedReferenceScene(const Scene& scene)
      : system(build_system(scene)), integrator(integrator_named(scene.integrator)) {}

  /// A and C go on from the velocity before the modification that moves the cloth.
  bool forgets_move() const {
    return integrator.family == Family::mixed && integrator.step != central_newmark;
  }
};

const PreparedReferenceScene& own(const PreparedScene& prepared) {
  return static_cast<const PreparedReferenceScene&>(prepared);
}

/// Backward differences change the velocity in the steps after, too: with r the ratio of the step
/// to the one before, a change grows to (1 + 2 r)/(1 + r) of itself.
double lasting_change(const Integrator& integrator, std::span<const State> past, double dt) {
  if (integrator.history < 2 || past.size() < 2) return 1;
  const double r = dt / (past.back().time - past[past.size() - 2].time);
  return (1 + 2 * r) / (1 + r);
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

void record_contact(PreparedScene& prepared) {
  auto& scene = static_cast<PreparedReferenceScene&>(prepared);
  scene.impulses = PerParticle3::Zero(3, scene.system.mass.size());
  std::vector<Filter>& filters = scene.system.filters;
  const auto objects = std::ranges::find_if(filters, [](const Filter& filter) {
    return std::holds_alternative<ObjectCollision>(filter);
  });
  if (objects == filters.end()) return;
  const auto place = objects - filters.begin();
  const CustomFilter before{
      [&scene](const Span&, const State&, const PerParticle3& v) { scene.unmodified = v; }};
  const CustomFilter after{[&scene](const Span& span, const State&, const PerParticle3& v) {
    if (scene.forgets_move() && span.end > span.start) return;
    scene.impulses +=
        scene.lasting * (v - scene.unmodified) * scene.system.mass.matrix().asDiagonal();
  }};
  filters.insert(filters.begin() + place + 1, after);
  filters.insert(filters.begin() + place, before);
}

PerParticle3 take_contact_impulses(PreparedScene& prepared) {
  PerParticle3& impulses = static_cast<PreparedReferenceScene&>(prepared).impulses;
  return std::exchange(impulses, PerParticle3::Zero(3, impulses.cols()));
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
    auto& reference = static_cast<PreparedReferenceScene&>(prepared);
    if (reference.impulses.size() > 0)
      reference.lasting = lasting_change(reference.integrator, past, dt);
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
