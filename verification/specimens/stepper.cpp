#include "verification/specimens/stepper.h"

#include <utility>

#include "verification/evidence.h"
#include "verification/specimens/differences.h"
#include "verification/specimens/random.h"

namespace foldproof {

Stepper::Stepper(const Subject& subject, Scene scene, const std::string& integrator)
    : subject_(subject), scene_(std::move(scene)) {
  scene_.integrator = integrator;
  prepared_ = require_offered(subject.prepare, "prepare")(scene_);
}

State Stepper::step(const State& s, double h) {
  return require_offered(subject_.step, "step")(*prepared_, {&s, 1}, h, work_);
}

State Stepper::step_after(const std::vector<State>& past, double h) {
  return require_offered(subject_.step, "step")(*prepared_, past, h, work_);
}

State Stepper::run(State s, double h, int steps) {
  for (int n = 0; n < steps; ++n) s = step(s, h);
  return s;
}

PerParticle3 Stepper::elastic_forces(const State& s) const {
  return require_offered(subject_.elastic_forces, "elastic_forces")(*prepared_, s);
}

PerParticle3 Stepper::damping_forces(const State& s, const PerParticle3& v) const {
  return require_offered(subject_.damping_forces, "damping_forces")(*prepared_, s, v);
}

State step_once(const std::string& integrator, const System& system, const State& s, double h) {
  Work work;
  return integrator_named(integrator).step(system, {&s, 1}, h, work);
}

double growth(Stepper& stepper, const State& start, double h, int steps) {
  const double small = 1e-7 * extent(start.x), duration = steps * h;
  Random random(41);
  State plain = start, disturbed = start;
  disturbed.x += random.vectors(start.x.cols(), small);
  disturbed.v += random.vectors(start.x.cols(), small / duration);
  Worst grown;
  grown.observe(1);
  for (int n = 0; n < steps; ++n) {
    plain = stepper.step(plain, h);
    disturbed = stepper.step(disturbed, h);
    grown.observe(largest_difference(plain.x, disturbed.x) / small);
    grown.observe(largest_difference(plain.v, disturbed.v) * duration / small);
  }
  return grown.value();
}

}  // namespace foldproof
