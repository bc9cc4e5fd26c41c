// Steps that are too long: how far they can be doubled, and that short ones gain no energy.

#include "verification/subjects/suite/laws.h"

namespace foldproof {

namespace {

using namespace suite;

constexpr double duration = 0.256;  // s
constexpr double tolerance = 0.05;  // of the energy scale [1]

/// The largest kinetic energy beyond what gravity has done, over m g size [1]. The sheet starts at
/// rest in its rest shape, where its elastic energy is least; so a sheet that gains none has none,
/// whatever its elastic law.
double gained(Trial& trial, double step) {
  PortableScene scene = hanging_sheet();
  scene.dt = step;
  const long steps = std::lround(duration / step), frames = std::min<long>(steps, 64);
  std::vector<long> at;
  for (long k = 1; k <= frames; ++k) at.push_back(k * steps / frames);
  Worst worst;
  for (const Snapshot& now : trial.motion(scene, at))
    worst.observe(gained_energy(scene, scene.x, now));
  return worst.value() / (scene.mass.sum() * scene.gravity.norm() * largest(scene.x));
}

/// The same; NaN if the solver gives up on what has become unstable.
double gained_or_failed(Trial& trial, double step) {
  try {
    return gained(trial, step);
  } catch (const SolverFailure& failure) {
    if (failure.cause != "error" && failure.cause != "nan") throw;
    trial.restart();
    return nan;
  }
}

Finding small_steps_gain_no_energy(Trial& trial) {
  const double usual = hanging_sheet().dt;
  Table measured = table_of(
      "step [s] | gained energy [of the weight times the size] | "
      "gained in a small step [of the weight times the size]");
  double stable = 0;
  for (double step = usual / 8; step <= duration / 2; step *= 2) {
    const bool is_small = step < usual / 4;
    const double gain = is_small ? gained(trial, step) : gained_or_failed(trial, step);
    measured.row(step, gain, is_small ? gain : 0);
    if (!(gain <= tolerance)) break;
    stable = step;
  }
  return judge_worst(measured, tolerance,
                     "empirical: the sheet falls through eight times as much in free fall; a first "
                     "order scheme errs by dt/t, 0.1 % of it",
                     fmt::format("by doubling, the largest step that gains none is {} s", stable));
}

}  // namespace

std::vector<Law> stability_laws() {
  return {
      {"stability.small-steps-gain-no-energy",
       "With short steps, a hanging sheet never moves faster than its fall allows.",
       "conservation of energy", small_steps_gain_no_energy, "held"},
  };
}

}  // namespace foldproof
