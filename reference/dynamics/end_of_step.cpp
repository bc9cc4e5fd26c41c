#include "reference/dynamics/end_of_step.h"

namespace foldproof {

State end_of_step(const System& system, const State& now, double h, PerParticle3 v_move, PerParticle3 v_end) {
  const double end = now.time + h;
  impose(mean_velocities(system.led, now.x, now.time, h), v_move);
  const PerParticle3 unfiltered = v_move;
  correct(system.filters, {now.time, end}, now, v_move);
  v_end += v_move - unfiltered;
  impose(velocities_at(system.led, end), v_end);
  State next{end, now.x + h * v_move, v_end};
  correct(system.filters, {end, end}, next, next.v);
  return next;
}

}  // namespace foldproof
