// monotonicity: how motions come to rest that damping alone brings there, in steps far longer
// than they last.
#include <cmath>
#include <limits>

#include "convergence/damping/damped_motion.h"
#include "convergence/damping/monotonicity.h"
#include "reference/dynamics/integrator.h"

namespace foldproof {

namespace {

NamedFinding passes_the_bound(const Subject& subject, const DampedMotion& hinge) {
  Worst worst;
  Table rows("motion [1]; h c/2 [1]; farthest [displacements]");
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
  Table rows("motion [1]; h c/2 [1]; overshoot or way back [displacements]");
  for (const double a : {0.7, 4.3, 10.0, 25.0, 400.0}) {
    const DampedRun run = run_damped(subject, hinge, method, a, 30);
    const double wrong = run.work.unfinished_solves == 0 ? worst_overshoot_or_reversal(run) : nan;
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
  Table rows("motion [1]; h c/2 [1]; farthest [displacements]");
  for (const double a : steps) {
    const DampedRun run = run_damped(subject, hinge, method, a, 30);
    const double far = run.work.unfinished_solves == 0 ? largest_progress(run) : nan;
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
  Table table(
      "method [1]; h c/2 [1]; farthest [displacements]; way back [displacements]; Newton "
      "iterations [a step]; unfinished solves [1]");
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

/// Coming to rest where the damping changes with the shape: a hinge that unfolds.
void add_nonlinear_hinge(const Subject& subject, const DampedMotion& hinge, StudyResult& result) {
  result.add({passes_the_bound(subject, hinge), scheme_b_passes_its_place(subject, hinge),
              is_monotone_on_a_hinge(subject, hinge, "linear-backward-euler"),
              passes_its_place(subject, hinge)});
  result.tables.push_back(hinge_table(subject, hinge));
}

constexpr double rounding = 1e-8;  // of the way
constexpr const char* why_rounding =
    "the displacement is a millionth of the triangle's size, so that each of up to 500 steps "
    "rounds by some 1e-10 of it; a linear motion differs from the derived one in nothing else";
constexpr double turning = 1e-5;  // of the way
constexpr const char* why_turning =
    "displacements on the sheet are nanometres: positions round by 1e-8 of them, nonlinearity is "
    "1e-7; a method that overshoots does so by a large part of the displacement";

// ---- the derived ways of schemes A, B and C (pure damping, r = (1 - a)/(1 + a) a step)

struct Paths {
  double first, total;  // over the exact one [1]
};

Paths derived_paths(const std::string& scheme, double a) {
  if (scheme == "A") return {2 * a * (1 - a), 1 - a * a};
  return {2 * a / (1 + a), 1};
}

std::string ways_in_words(const std::string& scheme) {
  return scheme == "A"
             ? "2a(1 - a) of its displacement in the first step and 1 - a^2 of it in all"
             : "2a/(1 + a) of its displacement in the first step and all of it in the end";
}

NamedFinding goes_its_derived_way(const Subject& subject, const DampedMotions& motions,
                                  const std::string& scheme) {
  Worst worst;
  Table ways(
      "h c/2 [1]; first step over the displacement [1]; all steps over the displacement [1]");
  for (const double a : {0.2, 0.7, 1.6, 4.3, 10.0, 25.0}) {
    const int steps = int(std::ceil(30 / -std::log(std::abs((1 - a) / (1 + a)))));
    const DampedRun run = run_damped(subject, motions.triangle, scheme, a, steps);
    const double first = run.progress[1][0], total = run.progress.back()[0];
    const Paths derived = derived_paths(scheme, a);
    worst.observe(std::abs(first - derived.first) / (1 + a * a));
    worst.observe(std::abs(total - derived.total) / (1 + a * a));
    ways.row(a, first, total);
  }
  return {
      "monotonicity.distance-is-as-derived." + scheme,
      "Under scheme " + scheme + " a motion that is only damped goes " + ways_in_words(scheme) +
          ", a = h c/2.",
      {{worst.value(), rounding, 0, "of (1 + a^2) times the displacement", why_rounding}, ways}};
}

// ---- scheme A

NamedFinding overshoots(const Subject& subject, const DampedMotions& motions) {
  constexpr double a = 10;
  Worst worst;
  Table rows("motion [1]; h c/2 [1]; farthest in the wrong direction [displacements]");
  for (const DampedMotion* motion : {&motions.triangle, &motions.sheet}) {
    const double wrong = largest_reversal(run_damped(subject, *motion, "A", a, 12));
    worst.observe(100 / wrong);
    rows.row(motion->name, a, wrong);
  }
  return {"monotonicity.overshoots.A",
          "Scheme A is not monotone: at h c/2 = 10 its explicit half step throws the cloth back by "
          "more than a hundred times the displacement it should make.",
          {{worst.value(), 1, 0, "1",
            "measured is a hundred over the displacement back; 2a(a - 1) = 180 is derived for one "
            "step"},
           rows}};
}

NamedFinding is_stable(const Subject& subject, const DampedMotions& motions) {
  Worst worst;
  Table rows("motion [1]; h c/2 [1]; largest kinetic energy after the start [of the start's]");
  for (const DampedMotion* motion : {&motions.triangle, &motions.sheet})
    for (const double a : {1.6, 10.0, 100.0}) {
      const std::vector<double> energies = run_damped(subject, *motion, "A", a, 40).kinetic_energy;
      Worst largest;
      for (size_t n = 1; n < energies.size(); ++n) largest.observe(energies[n]);
      worst.observe(largest.value());
      rows.row(motion->name, a, largest.value());
    }
  return {"monotonicity.stable-under-any-damping.A",
          "Scheme A is stable under damping however large: linear motions never have more kinetic "
          "energy than at the start.",
          {{worst.value(), 1, 0, "of the start's energy",
            "each step multiplies the speed of a mode by (1 - a)/(1 + a), whose size is below 1"},
           rows,
           "Judged in the energy of all modes together: thrown off by twenty thousand times the "
           "displacement (2 a^2 at a = 100), the fast modes leak into the slow ones, since the "
           "sheet is not quite linear."}};
}

// ---- schemes B and C

NamedFinding is_bounded(const Subject& subject, const DampedMotions& motions,
                        const std::string& scheme) {
  Table rows("motion [1]; h c/2 [1]; farthest [displacements]");
  for (const DampedMotion* motion : {&motions.triangle, &motions.sheet})
    for (const double a : {0.7, 4.3, 25.0, 110.0}) {
      const double far = largest_progress(run_damped(subject, *motion, scheme, a, 30));
      rows.row(motion->name, a, far);
    }
  return {"monotonicity.overshoot-is-bounded." + scheme,
          "Scheme " + scheme +
              " overshoots a linear motion by no more than its displacement, however large the "
              "damping.",
          {{rows.worst("farthest"), 2, 0, "displacements",
            "derived: it goes at most 2a/(1 + a) of the displacement, in the first step"},
           rows}};
}

NamedFinding alternates(const Subject& subject, const DampedMotions& motions,
                        const std::string& scheme) {
  double kept = 0;
  Table rows("motion [1]; h c/2 [1]; steps that keep the direction [of 8]");
  for (const double a : {1.6, 4.3, 10.0, 25.0}) {
    const DampedRun run = run_damped(subject, motions.triangle, scheme, a, 8);
    double here = 0;
    for (size_t n = 1; n < run.speed.size(); ++n)
      if (!(run.speed[n][0] * run.speed[n - 1][0] < 0)) ++here;
    kept += here;
    rows.row(motions.triangle.name, a, here);
  }
  return {"monotonicity.velocity-alternates." + scheme,
          "Scheme " + scheme +
              " is not monotone in the strict sense: for h c/2 > 1 the velocity changes its sign "
              "in every step.",
          {{kept, 0, 0, "steps", "derived: a step multiplies the velocity by (1 - a)/(1 + a) < 0"},
           rows}};
}

NamedFinding monotone_below_one(const Subject& subject, const DampedMotions& motions,
                                const std::string& scheme) {
  Table rows("motion [1]; h c/2 [1]; overshoot or way back [displacements]");
  for (const DampedMotion* motion : {&motions.triangle, &motions.sheet})
    for (const double a : {0.2, 0.7, 0.95}) {
      const double wrong = worst_overshoot_or_reversal(run_damped(subject, *motion, scheme, a, 40));
      rows.row(motion->name, a, wrong);
    }
  return {"monotonicity.monotone-in-short-steps." + scheme,
          "Scheme " + scheme + " is monotone while h c/2 < 1.",
          {{rows.worst("overshoot or way back"), turning, 0, "of the displacement", why_turning},
           rows}};
}

// ---- fully implicit methods

NamedFinding is_monotone(const Subject& subject, const DampedMotions& motions,
                         const std::string& method) {
  Table rows("motion [1]; h c/2 [1]; overshoot or way back [displacements]");
  for (const DampedMotion* motion : {&motions.triangle, &motions.sheet})
    for (const double a : {0.7, 4.3, 25.0, 400.0}) {
      const double wrong = worst_overshoot_or_reversal(run_damped(subject, *motion, method, a, 30));
      rows.row(motion->name, a, wrong);
    }
  return {"monotonicity.monotone." + method,
          "Linear motions are monotone at any step under " + method +
              ": nothing overshoots, nothing turns back.",
          {{rows.worst("overshoot or way back"), turning, 0, "of the displacement", why_turning},
           rows}};
}

/// The farthest that BDF2 gets from two exact values of v' = -c v: its recurrence on v, with x =
/// (1 - v) of the way, since it keeps v + c x exactly.
double farthest_by_bdf2(double a, int steps) {
  double before = 1, now = std::exp(-2 * a);
  Worst largest;
  largest.observe(1 - now);
  for (int n = 1; n < steps; ++n) {
    const double next = (4 * now - before) / (3 + 4 * a);
    before = now;
    now = next;
    largest.observe(1 - now);
  }
  return largest.value();
}

std::vector<NamedFinding> bdf2_findings(const Subject& subject, const DampedMotions& motions) {
  Worst least, error;
  Table rows("motion [1]; h c/2 [1]; farthest [displacements]");
  for (const double a : {0.5, 1.6, 4.3, 10.0}) {
    const double far = largest_progress(run_damped(subject, motions.triangle, "BDF2", a, 30));
    least.observe(far > 1 ? 0.01 / (far - 1) : std::numeric_limits<double>::infinity());
    error.observe(std::abs(far - farthest_by_bdf2(a, 30)));
    rows.row(motions.triangle.name, a, far);
  }
  return {{"monotonicity.overshoots.BDF2",
           "BDF2, started exactly, is not monotone at large steps: it overshoots by more than a "
           "hundredth of the displacement.",
           {{least.value(), 1, 0, "1", "measured is a hundredth over the overshoot"}, rows}},
          {"monotonicity.distance-is-as-derived.BDF2",
           "BDF2, started exactly, overshoots as its recurrence says.",
           {{error.value(), rounding, 0, "of the displacement", why_rounding}, rows}}};
}

StudyResult run_monotonicity(const Subject& subject, Tier tier, const Progress& progress) {
  const DampedMotions motions{expanding_triangle(), folding_hinge(),
                              sheet_in_plane(tier == Tier::quick ? 3 : 6)};
  StudyResult result;
  for (const Integrator& scheme : paper_schemes())
    result.findings.push_back(goes_its_derived_way(subject, motions, std::string(scheme.name)));
  result.add({overshoots(subject, motions), is_stable(subject, motions)});
  for (const std::string scheme : {"B", "C"}) {
    result.add({is_bounded(subject, motions, scheme), alternates(subject, motions, scheme),
                monotone_below_one(subject, motions, scheme)});
  }
  progress(0.3);
  for (const std::string method : {"backward-euler", "linear-backward-euler"})
    result.findings.push_back(is_monotone(subject, motions, method));
  result.add(bdf2_findings(subject, motions));
  add_nonlinear_hinge(subject, motions.hinge, result);
  progress(0.6);
  result.figures = monotonicity_figures(subject, motions, tier);
  progress(0.8);
  add_overdamped(subject, tier, result);
  progress(1);
  return result;
}

}  // namespace

Study monotonicity_study() {
  return {"monotonicity",
          "In steps far longer than the damping time, A overshoots a linear motion that damping "
          "alone brings to rest without bound, and B and C by at most the displacement itself, "
          "though they oscillate; backward Euler is monotone. On a folding hinge B and C overshoot "
          "too; so does fully implicit backward Euler, in steps of one to three damping times, and "
          "linearised backward Euler does not.",
          {"distance-is-as-derived", "overshoots.A", "overshoot-is-bounded", "velocity-alternates",
           "monotone", "overshoot-exceeds-the-bound-on-a-hinge.C", "overshoots-on-a-hinge.B",
           "overshoots-on-a-hinge.backward-euler", "monotone-on-a-hinge.linear-backward-euler"},
          "BMF03 section 3",
          "Three motions that damping alone brings to rest: a triangle that expands (linear, known "
          "exactly), a hinge that folds (nonlinear, known by an oracle), a sheet whose modes all "
          "move. How far does each method overshoot, and does it turn back? c is the damping rate "
          "of the fastest motion, h the step.",
          run_monotonicity};
}

}  // namespace foldproof
