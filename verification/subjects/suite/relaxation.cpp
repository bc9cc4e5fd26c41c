#include "verification/subjects/suite/relaxation.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <vector>

#include "verification/subjects/suite/scenes.h"

namespace foldproof::suite {

namespace {

/// The kinetic energy beyond what the weight has done since it was unstrained, over m g L [1]: none
/// but the scheme's error, as long as the step is stable.
double gained(const PortableScene& scene, const Relaxation& relaxation, const Snapshot& now) {
  return (gained_energy(scene, relaxation.unstrained, now) - relaxation.stored) /
         (scene.mass.sum() * scene.gravity.norm() * relaxation.length + relaxation.stored);
}

constexpr double longest = 1.6;    // of a round [s]
constexpr double unstable = 0.05;  // m g L gained

/// From rest to the next peak of the kinetic energy; nothing if the step is unstable.
std::optional<PerParticle3> until_fastest(Trial& trial, const PortableScene& scene,
                                          const Relaxation& relaxation) {
  trial.prepare(scene);
  Snapshot last{scene.x, scene.v};
  for (double time = 0; time < longest; time += relaxation.glance) {
    Snapshot next = trial.solver().advance(scene.dt, std::lround(relaxation.glance / scene.dt));
    if (!(gained(scene, relaxation, next) <= unstable)) return {};
    if (kinetic_energy(scene, next.v) < kinetic_energy(scene, last.v)) break;
    last = std::move(next);
  }
  return last.x;
}

/// Nothing if the step is unstable.
std::optional<Relaxed> relaxed_in_steps(Trial& trial, PortableScene scene,
                                        const Relaxation& relaxation) {
  constexpr int most_rounds = 24;
  std::vector<PerParticle3> stops{scene.x, scene.x};
  double moved = nan;
  for (int k = 0; k < most_rounds && !(moved < relaxation.enough * relaxation.length); ++k) {
    const std::optional<PerParticle3> stop = until_fastest(trial, scene, relaxation);
    if (!stop) return {};
    scene.x = *stop;
    moved = largest(scene.x - stops[stops.size() - 2]);
    stops.push_back(scene.x);
  }
  return Relaxed{scene.x, moved, scene.dt};
}

}  // namespace

Relaxed relaxed(Trial& trial, PortableScene scene, const Relaxation& relaxation) {
  constexpr int tries = 4;  // the last in steps of 3.1e-6 s
  std::optional<SolverFailure> last;
  for (int k = 0; k < tries; ++k) {
    if (k > 0) scene.dt /= 4;
    last.reset();
    try {
      if (const std::optional<Relaxed> end = relaxed_in_steps(trial, scene, relaxation))
        return *end;
    } catch (const SolverFailure& failure) {
      if (failure.cause != "error" && failure.cause != "nan") throw;
      last = failure;
      trial.restart();
    }
  }
  const std::string shortest =
      fmt::format("in steps of {:.2g} s, the shortest that are tried, ", scene.dt);
  if (last) throw SolverFailure(last->cause, shortest + last->what(), last->kind);
  throw FailedWithoutNumber(shortest + "the cloth gains energy and does not come to rest",
                            "a shape at rest is compared");
}

}  // namespace foldproof::suite
