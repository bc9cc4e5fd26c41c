// Cost of a sweep of strain limits per step.
#include <fmt/format.h>

#include "reference/filters/strain_limit.h"
#include "scripts/program/bench/bench_parts.h"

namespace foldproof {

Record strain_rate(const Scene& load, double step, double step_seconds) {
  StrainLimits limits;
  limits.sweeps = 1;
  const StretchSprings springs = make_springs(load.mesh, *load.stretch);
  const StrainLimiter limiter =
      make_strain_limiter(limits, springs.springs, PerParticle::Ones(load.x.cols()));
  long beyond = 0;
  for (const Spring& spring : springs.springs) {
    const Vector3 p = load.x.col(spring.b) - load.x.col(spring.a) +
                      step * (load.v.col(spring.b) - load.v.col(spring.a));
    const double strain = p.norm() / spring.rest_length - 1;
    if (strain > limits.extension || strain < -limits.compression) ++beyond;
  }
  PerParticle3 v = load.v;
  const double seconds = least_seconds([&] {
    v = load.v;
    limit_strain(limiter, step, load.x, v);
  });
  return rate("strain-sweep",
              fmt::format("One sweep of strain limits, including the check of the remaining "
                          "violation, over that step without limits: {} springs, {:.0f} % of them "
                          "beyond a limit; the sweep takes {:.1f} ms.",
                          springs.springs.size(),
                          100.0 * double(beyond) / double(springs.springs.size()), 1e3 * seconds),
              seconds / step_seconds,
              {0.08, "1", "lower",
               "a sweep gathers the positions and velocities of two particles a spring, as one of "
               "some ten passes over springs of each of a step's two solves does; the check of the "
               "remaining violation is another"});
}

}  // namespace foldproof
