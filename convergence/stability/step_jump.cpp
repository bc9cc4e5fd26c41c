#include "convergence/stability/hard_limits.h"

#include <cmath>

#include "convergence/stability/stable_step.h"

namespace foldproof {

namespace {

constexpr double fraction = 0.9;                               // s: the long step over 2/omega
constexpr double one_minus_squared = 1 - fraction * fraction;  // 1 - s^2
constexpr int jump = 100;

/// A sheet that vibrates in one mode.
struct Vibration {
  const Subject& subject;
  const Scene& scene;
  const FastestMode& mode;
  PreparedScene& prepared;
};

double energy(const Vibration& of, const State& s) {
  const PerParticle mass = lumped_masses(of.scene.mesh, of.scene.density);
  return 0.5 * s.v.colwise().squaredNorm().dot(mass.transpose()) +
         require_offered(of.subject.potential_energy, "potential_energy")(of.prepared, s);
}

/// Energies after the jump over that at the start [1].
struct EnergyRange {
  Worst largest, over_least;  // largest, and one over the least
};

EnergyRange after_jump(const Vibration& of, double phase) {
  const double h = fraction * 2 / of.mode.omega;
  State s = start_state(of.scene);
  s.x += small_disturbance * of.mode.shape;
  const double start = energy(of, s);
  Work uncounted;
  const long fine = std::lround(phase / of.mode.omega / (h / jump));
  for (long i = 0; i < fine; ++i) s = of.subject.step(of.prepared, {&s, 1}, h / jump, uncounted);
  EnergyRange range;
  for (int i = 0; i < 60; ++i) {
    s = of.subject.step(of.prepared, {&s, 1}, h, uncounted);
    range.largest.observe(energy(of, s) / start);
    range.over_least.observe(start / energy(of, s));
  }
  return range;
}

}  // namespace

// At the step h = s (2/omega) the leapfrog keeps Q = v^2/2 + (1 - s^2) omega^2 x^2/2 of an undamped
// mode. Whatever its phase, the energy E at the jump gives a Q in [(1 - s^2) E, E]; afterwards the
// energy lies in [Q, Q/(1 - s^2)].
NamedFinding step_jump(const Subject& subject, Scene scene, const std::string& scheme) {
  scene.integrator = scheme;
  const auto prepared = require_offered(subject.prepare, "prepare")(scene);
  require_offered(subject.step, "step");
  const FastestMode mode = fastest_mode(subject, scene);
  Worst worst;
  Table energies{{"phase at the jump", "rad"},
                 {"least energy after it, over the start's", "1"},
                 {"largest energy after it, over the start's", "1"}};
  for (int k = 0; k < 8; ++k) {
    const double phase = 2 * pi * k / 8;
    const EnergyRange range = after_jump({subject, scene, mode, *prepared}, phase);
    energies.row(phase, 1 / range.over_least.value(), range.largest.value());
    worst.observe(range.largest.value() * one_minus_squared);
    worst.observe(range.over_least.value() * one_minus_squared);
  }
  return {"hard-limits.energy-is-bounded-across-a-step-jump." + scheme,
          "When the step jumps by 1 : 100 to s (2/omega), s = 0.9, the energy of scheme " + scheme +
              " stays within [1 - s^2, 1/(1 - s^2)] of what it was.",
          {{worst.value(), 1.01, 0, "1",
            "one for the derived range; a hundredth for the vibration being not quite the fastest "
            "mode alone"},
           energies,
           "measured is how far the range is used: the largest energy, or one over the least, "
           "times 1 - s^2"}};
}

}  // namespace foldproof
