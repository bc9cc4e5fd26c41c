#include "reference/dynamics/finish_step.h"

namespace foldproof {

State finish_step(const System& system, const State& now, double h, StepVelocities v, Work& work) {
  const double end = now.time + h;
  impose(mean_velocities(system.prescribed, now.x, now.time, h), v.move);
  const PerParticle3 unfiltered = v.move;
  correct(system.filters, {now.time, end, h}, now, v.move, work);
  v.end += v.move - unfiltered;
  impose(velocities_at(system.prescribed, end), v.end);
  State next{end, now.x + h * v.move, v.end, now.bonds};
  correct(system.filters, {end, end, h}, next, next.v, work);
  return next;
}

}  // namespace foldproof
