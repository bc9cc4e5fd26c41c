#include "convergence/stability/bdf2_growing_steps.h"

#include <cmath>

#include "convergence/stability/step_matrix.h"
#include "verification/oracles/stability.h"

namespace foldproof {

namespace {

/// The hinge's corner without any force: x'' = 0.
SteppedMotion bdf2_without_forces(const Subject& subject) {
  SmallMotion motion = hinge_oscillator(0);
  motion.scene.bending.reset();
  motion.scene.rest_angles.clear();
  return stepped_motion(subject, std::move(motion), "BDF2");
}

/// Factor on the difference of the two latest velocities in one step of ratio times the one before.
double difference_factor(const SteppedMotion& of, double ratio) {
  const double h = 1 / of.motion.omega0;
  const Eigen::MatrixXd matrix = step_matrix(of, {ratio * h, h});
  return -matrix(3, 1);  // v'' = (1 + p) v' - p v
}

NamedFinding zero_stability(const Subject& subject) {
  const SteppedMotion of = bdf2_without_forces(subject);
  double below = 1, above = 5;
  for (int i = 0; i < 45; ++i) {
    const double middle = (below + above) / 2;
    (difference_factor(of, middle) <= 1 ? below : above) = middle;
  }
  const oracles::Estimate exact = oracles::bdf2_largest_ratio();
  return {
      "variable-step-stability.BDF2.largest-step-ratio-is-as-derived",
      "With steps that grow by a constant ratio, BDF2 amplifies differences between solutions of "
      "x'' = 0 from the ratio 1 + sqrt(2) on.",
      {{std::abs((below + above) / 2 - exact.value), 1e-9, exact.uncertainty, "1",
        "the factor r^2/(1 + 2 r) is found to roundings, and its slope there is 0.35"},
       Table{{"ratio found", "1"}, {"1 + sqrt(2)", "1"}}.with_row((below + above) / 2, exact.value),
       ""}};
}

/// A corner in flight at v0, whose second state is disturbed: what comes of the disturbance after
/// steps that grow by `ratio` up to omega h = .001, over the disturbance.
double amplification(const SteppedMotion& of, double ratio) {
  constexpr int steps = 600;
  double h = 1e-3 / of.motion.omega0 * std::pow(ratio, -steps);
  State first = start_state(of.motion.scene), second = first;
  second.v(2, 0) = of.motion.omega0 * of.motion.disturbance;
  second.time = h;
  const double size = second.v(2, 0);
  std::vector<State> past = {first, second};
  Work uncounted;
  for (int i = 0; i < steps; ++i) {
    h *= ratio;
    State next = of.subject.step(*of.prepared, past, h, uncounted);
    past = {past[1], std::move(next)};
  }
  return std::abs(past[1].v(2, 0)) / size;
}

std::vector<NamedFinding> growing_steps(const std::string& where, const SteppedMotion& of) {
  constexpr double below = 2.40, above = 2.43;
  const auto factor = [](double r) { return r * r / (1 + 2 * r); };
  const double kept = amplification(of, below), grown = amplification(of, above);
  const double bound = 1 / (1 - factor(below));  // 1 + p + p^2 + ...
  return {
      {"variable-step-stability.BDF2.bounded-below-that-ratio." + where,
       "Steps that grow by 2.40 leave BDF2 bounded on " + where + ".",
       {{kept / bound, 1, 0, "1",
         "differences fall by p = r^2/(1 + 2 r) each step, so they add up to less than 1/(1 - p)"},
        Table{{"amplification after 600 steps", "1"}, {"1/(1 - p)", "1"}}.with_row(kept, bound),
        ""}},
      {"variable-step-stability.BDF2.grows-above-that-ratio." + where,
       "Steps that grow by 2.43 make BDF2 grow without bound on " + where + ", though implicit.",
       {{1000 / grown, 1, 0, "1",
         "p = 1.0077 to the power 600 is 98, and the sum exceeds ten thousand; a thousand "
         "separates it from bounded motion"},
        Table{{"amplification after 600 steps", "1"}}.with_row(grown),
        "measured is a thousand over the amplification"}}};
}

}  // namespace

std::vector<NamedFinding> bdf2_growing_steps(const Subject& subject) {
  std::vector<NamedFinding> findings = {zero_stability(subject)};
  for (NamedFinding& finding : growing_steps("free-flight", bdf2_without_forces(subject)))
    findings.push_back(std::move(finding));
  for (NamedFinding& finding :
       growing_steps("the-hinge", stepped_motion(subject, hinge_oscillator(0), "BDF2")))
    findings.push_back(std::move(finding));
  return findings;
}

}  // namespace foldproof
