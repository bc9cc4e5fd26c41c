#include "convergence/nonlinear_hinge.h"

namespace foldproof {

namespace {

NamedFinding passes_the_bound(const Subject& subject, const DampedMotion& hinge) {
  Worst worst;
  MotionRows rows("farthest", "ways");
  for (const double a : {10.0, 25.0}) {
    const double far = farthest(run_damped(subject, hinge, "C", a, 30));
    worst.see(2 / far);
    rows.add(hinge, a, far);
  }
  return {
      "monotonicity.beyond-the-bound.C",
      "On a hinge whose damping falls as it unfolds, scheme C overshoots by more than the way itself.",
      {{worst.value(), 1, 0, "1",
        "measured is the bound of linear motions over the farthest. C's last velocity comes from the damping "
        "at the "
        "step's start, explicitly, and is tamed by that at its end: (1 - a)/(1 + a') has no bound when a' < "
        "a"},
       rows.columns(),
       "Scheme B takes both at the step's ends the other way round: 1.6 ways here, see the table."}};
}

NamedFinding linearised_is_monotone(const Subject& subject, const DampedMotion& hinge) {
  Worst worst;
  MotionRows rows("overshoot or way back", "ways");
  for (const double a : {0.7, 4.3, 10.0, 25.0, 400.0}) {
    const double wrong = misconduct(run_damped(subject, hinge, "linear-backward-euler", a, 30));
    worst.see(wrong);
    rows.add(hinge, a, wrong);
  }
  return {
      "monotonicity.monotone-on-a-hinge.linear-backward-euler",
      "Linearised backward Euler is monotone on a nonlinear hinge too, as nearly as the exact motion is.",
      {{worst.value(), 0.004, 0, "ways", "the exact motion passes its place of rest by 0.4 % and returns"},
       rows.columns(),
       ""}};
}

Table hinge_table(const Subject& subject, const DampedMotion& hinge) {
  Column method{"method", "1", std::vector<std::string>{}}, as{"h c/2", "1", std::vector<double>{}},
      far{"farthest", "ways", std::vector<double>{}}, back{"way back", "ways", std::vector<double>{}},
      unfinished{"unfinished solves", "1", std::vector<double>{}};
  for (const std::string name :
       {"B", "C", "implicit-midpoint", "BDF2", "backward-euler", "linear-backward-euler"})
    for (const double a : {0.7, 4.3, 10.0, 25.0}) {
      const DampedRun run = run_damped(subject, hinge, name, a, 30);
      std::get<1>(method.values).push_back(name);
      std::get<0>(as.values).push_back(a);
      std::get<0>(far.values).push_back(farthest(run));
      std::get<0>(back.values).push_back(backward(run));
      std::get<0>(unfinished.values).push_back(double(run.work.unfinished_solves));
    }
  return {"hinge",
          "A folding hinge: 1 is its exact way; where solves are unfinished, Newton's method has not found "
          "the step",
          {method, as, far, back, unfinished}};
}

}  // namespace

void add_nonlinear_hinge(const Subject& subject, const DampedMotion& hinge, StudyResult& result) {
  result.findings.push_back(passes_the_bound(subject, hinge));
  result.findings.push_back(linearised_is_monotone(subject, hinge));
  result.tables.push_back(hinge_table(subject, hinge));
}

}  // namespace foldproof
