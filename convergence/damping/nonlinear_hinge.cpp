#include "convergence/damping/monotonicity.h"

#include <limits>

namespace foldproof {

namespace {

NamedFinding passes_the_bound(const Subject& subject, const DampedMotion& hinge) {
  Worst worst;
  Table rows{{"motion", "1"}, {"h c/2", "1"}, {"farthest", "displacements"}};
  for (const double a : {10.0, 25.0}) {
    const double far = largest_progress(run_damped(subject, hinge, "C", a, 30));
    worst.observe(2 / far);
    rows.row(hinge.name, a, far);
  }
  return {"monotonicity.overshoot-exceeds-the-bound-on-a-hinge.C",
          "On a hinge whose damping falls as it unfolds, scheme C overshoots by more than the "
          "displacement itself.",
          {{worst.value(), 1, 0, "1",
            "measured is the bound for linear motions over the farthest point. C's last velocity "
            "takes the damping at the step's start explicitly and the damping at its end "
            "implicitly: (1 - a)/(1 + a') has no bound when a' < a"},
           rows,
           "Scheme B takes the two in the opposite order, and stays below that: see the table."}};
}

NamedFinding is_monotone_on_a_hinge(const Subject& subject, const DampedMotion& hinge,
                                    const std::string& method) {
  Table rows{{"motion", "1"}, {"h c/2", "1"}, {"overshoot or way back", "displacements"}};
  for (const double a : {0.7, 4.3, 10.0, 25.0, 400.0}) {
    const DampedRun run = run_damped(subject, hinge, method, a, 30);
    const double wrong = run.work.unfinished_solves == 0 ? worst_overshoot_or_reversal(run)
                                                         : std::numeric_limits<double>::quiet_NaN();
    rows.row(hinge.name, a, wrong);
  }
  return {"monotonicity.monotone-on-a-hinge." + method,
          "On a nonlinear hinge too motion is monotone under " + method +
              ", as nearly as the exact motion is.",
          {{rows.worst("overshoot or way back"), 0.004, 0, "displacements",
            "the exact motion overshoots its rest angle by 0.4 % and returns"},
           rows,
           "A solve that did not finish would count as NaN."}};
}

/// How far a method goes in steps h = 2 a/c, and how close that is to 1.1 displacements.
Finding distance_on_a_hinge(const Subject& subject, const DampedMotion& hinge,
                            const std::string& method, const std::vector<double>& steps,
                            const std::string& why, const std::string& note) {
  Worst worst;
  Table rows{{"motion", "1"}, {"h c/2", "1"}, {"farthest", "displacements"}};
  for (const double a : steps) {
    const DampedRun run = run_damped(subject, hinge, method, a, 30);
    const double far = run.work.unfinished_solves == 0 ? largest_progress(run)
                                                       : std::numeric_limits<double>::quiet_NaN();
    worst.observe(1.1 / far);
    rows.row(hinge.name, a, far);
  }
  return {
      {worst.value(), 1, 0, "1", "measured is 1.1 displacements over the farthest point; " + why},
      rows,
      note};
}

NamedFinding passes_its_place(const Subject& subject, const DampedMotion& hinge) {
  return {
      "monotonicity.overshoots-on-a-hinge.backward-euler",
      "On a hinge without stiffness, whose damping changes as it folds, fully implicit backward "
      "Euler goes farther than the exact motion by more than a tenth of the displacement.",
      distance_on_a_hinge(subject, hinge, "backward-euler", {0.7, 1.1, 1.6},
                          "the damping at a step's end, where the hinge is folded farther, is less "
                          "than during the step. Without stiffness nothing brings it back",
                          "A solve that did not finish would count as NaN. In steps longer still "
                          "the step's equation has several solutions, and Newton's method does not "
                          "always find one: see the table.")};
}

NamedFinding scheme_b_passes_its_place(const Subject& subject, const DampedMotion& hinge) {
  return {"monotonicity.overshoots-on-a-hinge.B",
          "On a hinge whose damping falls as it unfolds, scheme B goes farther than the exact "
          "motion by more than a tenth of the displacement.",
          distance_on_a_hinge(
              subject, hinge, "B", {4.3, 10, 25},
              "the first step of a linear motion goes 2a/(1 + a) of it, 1.6 at least", "")};
}

Table hinge_table(const Subject& subject, const DampedMotion& hinge) {
  Table table{{"method", "1"},
              {"h c/2", "1"},
              {"farthest", "displacements"},
              {"way back", "displacements"},
              {"Newton iterations", "a step"},
              {"unfinished solves", "1"}};
  for (const std::string name :
       {"B", "C", "implicit-midpoint", "BDF2", "backward-euler", "linear-backward-euler"})
    for (const double a : {0.7, 4.3, 10.0, 25.0}) {
      const DampedRun run = run_damped(subject, hinge, name, a, 30);
      table.row(name, a, largest_progress(run), largest_reversal(run),
                double(run.work.newton_iterations) / double(run.speed.size() - 1),
                run.work.unfinished_solves);
    }
  return {"hinge", "A folding hinge: 1 is its exact displacement", table};
}

}  // namespace

void add_nonlinear_hinge(const Subject& subject, const DampedMotion& hinge, StudyResult& result) {
  result.findings.push_back(passes_the_bound(subject, hinge));
  result.findings.push_back(scheme_b_passes_its_place(subject, hinge));
  result.findings.push_back(is_monotone_on_a_hinge(subject, hinge, "linear-backward-euler"));
  result.findings.push_back(passes_its_place(subject, hinge));
  result.tables.push_back(hinge_table(subject, hinge));
}

}  // namespace foldproof
