// Quantities of cases in which something sticks.
#include <algorithm>
#include <cmath>

#include "verification/cases/quantities.h"

namespace foldproof {

namespace {

/// Particles that stick to something: bonds to several triangles of one patch count once.
double stuck_particles(const Scene& scene, const State& s) {
  return double(Sticking{scene.sticky}.targets_at(s).size());
}

double stuck_at_end(const RunView& run) { return stuck_particles(run.scene, run.result.last); }

/// The largest distance of a stuck particle from its target.
double slack(const Scene& scene, const State& s) {
  Worst worst;
  for (const StickyTarget& target : Sticking{scene.sticky}.targets_at(s))
    worst.observe(target.distance);
  return worst.value();
}

/// Of the lowest particle, since the start; up is against gravity.
double rise(const Scene& scene, const State& s) {
  const Vector3 up = -scene.gravity->normalized();
  return (up.transpose() * s.x).minCoeff<Eigen::PropagateNaN>() -
         (up.transpose() * scene.x).minCoeff();
}

std::string without_sticky(const Scene& scene) {
  return scene.sticky.empty() ? "the case has no [[sticky]]" : "";
}

}  // namespace

std::vector<Quantity> sticking_quantities() {
  return {
      {"sticks", "particles", "Particles come to stick.", Sense::at_least, Scope::this_shape,
       stuck_particles, nullptr, without_sticky},
      {"lets_go", "particles", "At the end no more than this many particles stick.", Sense::at_most,
       Scope::this_shape, nullptr, stuck_at_end, without_sticky},
      {"keeps_hold", "m", "What sticks stays near the place at which it came to stick.",
       Sense::at_most, Scope::any_cloth, slack, nullptr, without_sticky},
      {"is_lifted", "m", "All of the cloth is lifted off what it lay on.", Sense::at_least,
       Scope::this_shape, rise, nullptr, without_gravity},
  };
}

}  // namespace foldproof
