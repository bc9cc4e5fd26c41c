// stability-sheet: the largest stable step of a sheet over damping and resolution: what is implicit
// in the damping and what is not.
#include <cmath>

#include "convergence/stability/stability_sheet.h"
#include "convergence/stability/step_matrix.h"
#include "reference/dynamics/integrator.h"
#include "verification/oracles/stability.h"

namespace foldproof {

namespace {

/// Flat, springs resist in the plane alone and hinges across it: with one of them damped
/// some modes are not.
bool damps_all(const Damping& damping) { return damping.springs > 0 && damping.bending > 0; }

/// First and second order Runge-Kutta methods leave the imaginary axis at once: an undamped mode
/// grows at any step.
bool grows_undamped(const Integrator& integrator) {
  return integrator.family == Family::fully_explicit && integrator.order <= 2;
}

// ---- a small clamped sheet: all of its modes at once

/// Known limits of a clamped sheet, from its linear forces [s].
double known_limit(const Integrator& integrator, const LinearForces& forces) {
  if (integrator.name == "C")
    return oracles::largest_variable_newmark_step(forces.stiffness, forces.damping).value;
  if (integrator.family == Family::mixed)
    return oracles::largest_leapfrog_step(forces.stiffness).value;
  return oracles::largest_runge_kutta_step(integrator.order,
                                           oracles::system_rates(forces.stiffness, forces.damping))
      .value;
}

/// Steps of one method over damping constants.
Table damped_limits(const Subject& subject, const Integrator& integrator, const Damping& damping,
                    int points) {
  constexpr double omega0 = 50, threshold = 1e-6;
  Table limits("multiple of the damping [1]; largest stable step [s]; as known [s]; 2/omega [s]");
  for (const double times : geometric_range(0.01, 100, points)) {
    const SmallMotion motion =
        free_motion(clamped_sheet(times * damping.springs, times * damping.bending), omega0);
    const LinearForces forces = linear_forces(subject, motion);
    const double known = known_limit(integrator, forces);
    limits.row(times,
               largest_constant_step(stepped_motion(subject, motion, integrator.name),
                                     {known / 2, known * 4, threshold, 11}),
               known, oracles::largest_leapfrog_step(forces.stiffness).value);
  }
  return limits;
}

const char* const why_percent =
    "a spectral radius of 1 + 1e-6 counts as growth; where damping is heaviest, the radius exceeds "
    "1 by only a hundredth of the excess of the step over its limit, so the limit is found to "
    "1e-3; a limit that fell with the damping would be off by a large factor";

NamedFinding independence(const Integrator& integrator, const Damping& damping,
                          const Table& limits) {
  const std::string name(integrator.name);
  return {"stability-sheet.limit-does-not-depend-on-damping." + damping.name + "." + name,
          "On a sheet with " + damping.words + ", scheme " + name +
              " is stable up to 2/omega, the limit without damping, however large the damping.",
          {{largest_deviation(limits, "largest stable step", "2/omega"), 0.01, 0, "1", why_percent},
           limits,
           "measured is the largest relative deviation from 2/omega while the damping rises by a "
           "factor of 1e4"}};
}

NamedFinding never_narrower(const Damping& damping, const Table& limits) {
  return {"stability-sheet.damping-never-lowers-the-limit." + damping.name + ".C",
          "On a sheet with " + damping.words + ", scheme C is stable up to 2/omega at least.",
          {{largest_ratio(limits, "2/omega", "largest stable step"), 1.001, 0, "1",
            "the bisection and the linearised forces leave less than a thousandth"},
           limits,
           "measured is the largest 2/omega over the largest stable step, while the damping rises "
           "by a factor of 1e4"}};
}

NamedFinding as_known(const Integrator& integrator, const Damping& damping, const Table& limits) {
  const std::string name(integrator.name);
  const bool mixed = integrator.family == Family::mixed;
  return {
      "stability-sheet.limit-is-as-derived." + damping.name + "." + name,
      "On a sheet with " + damping.words + ", the largest stable step of " +
          std::string(integrator.title) +
          (mixed ? " is where 4 + 2 h C - h^2 K becomes singular."
                 : " is where its stability polynomial exceeds 1 at one of the sheet's rates."),
      {{largest_deviation(limits, "largest stable step", "as known"), 0.01, 0, "1", why_percent},
       limits,
       "measured is the largest relative deviation while the damping rises by a factor of 1e4"}};
}

/// Heavy damping: the limits at the two largest dampings.
void add_heavy(const Integrator& integrator, const Table& limits, Table& heavy) {
  const double exponent = last_exponent(limits, "multiple of the damping", "largest stable step");
  heavy.row(std::string(integrator.name), limits.numbers("largest stable step").back(), exponent,
            std::abs(exponent + 1));
}

NamedFinding heavy_damping(const Damping& damping, Table heavy) {
  return {"stability-sheet.heavy-damping-shortens-explicit-steps." + damping.name,
          "On a sheet with " + damping.words +
              ", where damping decides, the largest stable step of explicit methods is inversely "
              "proportional to it.",
          judge_worst(std::move(heavy), 0.1,
                      "a limit that did not fall has exponent 0, one that fell with the square -2",
                      "measured is the largest |exponent + 1| between the two largest dampings")};
}

void add_clamped_sheet(const Subject& subject, Tier tier, const Progress& progress,
                       StudyResult& result) {
  const int points = tier == Tier::quick ? 5 : 13;
  double done = 0;
  for (const Damping& damping : dampings()) {
    Figure figure{
        "over-damping-" + damping.name,
        "Largest stable step of a clamped sheet, " + damping.words,
        {"multiple of the damping constants", "1", Scale::log},
        {"largest stable step", "s", Scale::log},
        "The constants are 0.3 N s/m of springs, 0.01 N s of bending. From the spectral radius of "
        "the whole sheet's step. A and B keep the undamped limit, that of C is never shorter, and "
        "heavy damping shortens that of explicit methods in proportion. Forward Euler and explicit "
        "midpoint have no stable step at all where some modes are undamped."};
    Table heavy(
        "method [1]; largest stable step [s]; exponent in the damping [1]; |exponent + 1| [1]");
    for (const Integrator& integrator : integrators()) {
      if (integrator.family == Family::fully_implicit) continue;
      if (!damps_all(damping) && grows_undamped(integrator)) continue;
      const Table limits = damped_limits(subject, integrator, damping, points);
      if (integrator.name == "A" || integrator.name == "B")
        result.findings.push_back(independence(integrator, damping, limits));
      else
        result.findings.push_back(as_known(integrator, damping, limits));
      if (integrator.name == "C") result.findings.push_back(never_narrower(damping, limits));
      if (integrator.family == Family::fully_explicit) add_heavy(integrator, limits, heavy);
      figure.curves.push_back(curve_of(std::string(integrator.name), limits,
                                       "multiple of the damping", "largest stable step"));
      progress(0.7 * ++done / 21);
    }
    result.findings.push_back(heavy_damping(damping, std::move(heavy)));
    result.figures.push_back(std::move(figure));
  }
}

StudyResult run_stability_sheet(const Subject& subject, Tier tier, const Progress& progress) {
  StudyResult result;
  add_clamped_sheet(subject, tier, progress, result);
  add_refinement(subject, tier, result);
  progress(0.85);
  add_tenth(subject, tier, result);
  progress(0.9);
  add_stability_maps(subject, tier, result);
  progress(1);
  return result;
}

}  // namespace

Study stability_sheet_study() {
  return {
      "stability-sheet",
      "On a sheet the largest stable step of A and B does not depend on the damping, and "
      "damping never shortens that of C; where damping decides, that of explicit methods is "
      "inversely proportional to it, and proportional to dx^2 with damped springs, to dx^3 "
      "with damped bending.",
      {"limit-does-not-depend-on-damping", "damping-never-lowers-the-limit",
       "heavy-damping-shortens-explicit-steps", "damping-limit-exponent", "limit-is-as-derived"},
      "BMF03 section 3",
      "A small clamped sheet of springs and hinges is stepped from each unit disturbance, "
      "which gives the matrix of the whole step. The step at which its spectral radius exceeds "
      "1 is found by bisection while the damping rises by a factor of 1e4. Under refinement "
      "the largest rate of the damping is found by power iteration. The paper's example, cells "
      "of a tenth, is computed and confirmed by runs.",
      run_stability_sheet};
}

}  // namespace foldproof
