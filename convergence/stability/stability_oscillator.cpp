// stability-oscillator: the largest stable step of every method over the damping ratio of
// one oscillator.

#include "convergence/stability/step_matrix.h"
#include "convergence/study.h"
#include "reference/dynamics/integrator.h"
#include "verification/oracles/exact_solutions.h"
#include "verification/oracles/stability.h"

namespace foldproof {

namespace {

constexpr double threshold = 1e-8;

/// Known values of omega times the largest stable step; infinite for methods without limit.
double known_limit(const Integrator& integrator, double zeta) {
  using oracles::Scheme;
  const oracles::Oscillator oscillator{1, 2 * zeta, 0, 0};
  if (integrator.name == "A") return oracles::largest_stable_step(Scheme::mixed, oscillator).value;
  if (integrator.name == "B")
    return oracles::largest_stable_step(Scheme::central_newmark, oscillator).value;
  if (integrator.name == "C")
    return oracles::largest_stable_step(Scheme::variable_step_newmark, oscillator).value;
  if (integrator.family == Family::fully_explicit)
    return oracles::largest_runge_kutta_step(integrator.order, oracles::oscillator_rates(1, zeta))
        .value;
  return std::numeric_limits<double>::infinity();
}

double spectral_radius_at(const SteppedMotion& of, double omega_h) {
  const double h = omega_h / of.motion.omega0;
  return spectral_radius(step_matrix(of, {h, h}));
}

/// omega h of the first step that grows, from a twentieth of the known limit on.
double measured_limit(const SteppedMotion& of, double known) {
  const double omega = of.motion.omega0;
  return omega * largest_constant_step(of, {known / 20 / omega, known * 20 / omega, threshold});
}

/// omega h against zeta of one method.
Table limit_row(const Subject& subject, const Integrator& integrator,
                const std::vector<double>& ratios) {
  Table row("damping ratio [1]; largest stable omega h [1]; as known [1]");
  for (const double zeta : ratios) {
    const double known = known_limit(integrator, zeta);
    if (!(known > 0)) continue;  // unstable at every step: judged by itself
    row.row(zeta,
            measured_limit(stepped_motion(subject, hinge_oscillator(zeta), integrator.name), known),
            known);
  }
  return row;
}

NamedFinding limit_finding(const Integrator& integrator, const Table& row) {
  const std::string name(integrator.name), title(integrator.title);
  const bool mixed = integrator.family == Family::mixed;
  const std::string what = !mixed ? "where its stability polynomial exceeds 1"
                           : name == "C"
                               ? "2 (zeta + sqrt(1 + zeta^2)) over omega, so that damping widens it"
                               : "2/omega for any damping";
  return {"stability-oscillator.limit-is-as-derived." + name,
          "The largest stable step of " + title + " on the damped oscillator is " + what + ".",
          {{largest_deviation(row, "largest stable omega h", "as known"), 1e-3, 0, "1",
            "a tenth of a percent tells any two of these formulas apart; a spectral radius of 1 + "
            "1e-8 counts as growth, which puts a limit off by a ten-thousandth at most, where the "
            "radius grows most slowly"},
           row,
           "measured is the largest relative deviation"}};
}

/// Heavy damping: the row between its two largest ratios.
void add_heavy(const Integrator& integrator, const Table& row, Table& heavy) {
  const double exponent = last_exponent(row, "damping ratio", "largest stable omega h");
  heavy.row(std::string(integrator.name), row.numbers("largest stable omega h").back(), exponent,
            std::abs(exponent + 1));
}

NamedFinding heavy_finding(Table heavy) {
  return {"stability-oscillator.heavy-damping-shortens-explicit-steps",
          "Under heavy damping the largest stable step of every fully explicit method is inversely "
          "proportional to the damping ratio.",
          judge_worst(std::move(heavy), 0.1,
                      "a limit that did not fall has exponent 0, one that fell with the square -2; "
                      "at a ratio zeta the fast rate is 2 zeta omega less a share of 1/(4 zeta^2)",
                      "measured is the largest |exponent + 1| between the two largest ratios; for "
                      "light damping see limit-is-as-derived")};
}

/// Methods that leave the imaginary axis at once: first and second order.
NamedFinding undamped_growth(const Subject& subject, const Integrator& integrator) {
  const SteppedMotion of = stepped_motion(subject, hinge_oscillator(0), integrator.name);
  const int power = integrator.order == 1 ? 2 : 4;  // |R(iy)|^2 = 1 + y^2, 1 + y^4/4
  Worst worst;
  Table excesses{{"omega h", "1"}, {"squared spectral radius - 1", "1"}};
  for (const double y : {0.05, 0.13, 0.37, 0.9}) {
    const double excess = std::pow(spectral_radius_at(of, y), 2) - 1;
    excesses.row(y, excess);
    worst.observe(std::abs(excess / (std::pow(y, power) / (power == 2 ? 1 : 4)) - 1));
  }
  const std::string name(integrator.name);
  return {"stability-oscillator.undamped-motion-grows." + name,
          "Without damping " + std::string(integrator.title) +
              " grows at every step: |R(iy)|^2 = 1 + y^" + (power == 2 ? "2." : "4/4."),
          {{worst.value(), 1e-3, 0, "1",
            "the smallest excess, 1.6e-6, is found to 1e-9; another power of y is off by a factor"},
           excesses,
           "measured is the largest relative deviation of the excess"}};
}

NamedFinding unlimited_finding(const Subject& subject, const Integrator& integrator) {
  const std::string largest = "largest spectral radius, omega h .01 to 1000";
  Table radii{{"damping ratio", "1"}, {largest, "1"}};
  for (const double zeta : {0.0, 0.01, 0.1, 0.5, 1.0, 10.0}) {
    const SteppedMotion of = stepped_motion(subject, hinge_oscillator(zeta), integrator.name);
    Worst here;
    for (const double omega_h : geometric_range(0.01, 1000, 26))
      here.observe(spectral_radius_at(of, omega_h));
    radii.row(zeta, here.value());
  }
  Worst worst;
  for (const double radius : radii.numbers(largest)) worst.observe(radius - 1);
  return {"stability-oscillator.has-no-limit." + std::string(integrator.name),
          "On the damped oscillator " + std::string(integrator.title) + " is stable at every step.",
          {{worst.value(), threshold, 0, "1", "what counts as growth everywhere in this study"},
           radii,
           "measured is the largest spectral radius, less 1"}};
}

Curve known_curve(const Integrator& integrator) {
  Curve curve{"limit as known"};
  for (const double zeta : geometric_range(0.01, 10, 61))
    curve.point(known_limit(integrator, zeta), zeta);
  return curve;
}

Map radius_map(const Subject& subject, const Integrator& integrator, int fineness) {
  const std::string name(integrator.name);
  Map map{"radius-" + name,
          "Spectral radius of one step of " + std::string(integrator.title) + " (" + name + ")",
          {"step times frequency, omega h", "1", Scale::log},
          {"damping ratio", "1", Scale::log},
          geometric_range(0.1, 30, 12 * fineness + 1),
          geometric_range(0.01, 10, 9 * fineness + 1),
          {},
          "spectral radius",
          "1",
          Scale::log,
          "Above 1 a disturbance grows from step to step.",
          {}};
  for (const double zeta : map.y_values) {
    const SteppedMotion of = stepped_motion(subject, hinge_oscillator(zeta), name);
    for (const double omega_h : map.x_values) map.values.push_back(spectral_radius_at(of, omega_h));
  }
  if (integrator.family != Family::fully_implicit) {
    map.caption += " The curve is the limit known from the formulas, drawn over what was measured.";
    map.curves.push_back(known_curve(integrator));
  } else {
    map.caption += " This method has no limit.";
  }
  return map;
}

StudyResult run_stability_oscillator(const Subject& subject, Tier tier, const Progress& progress) {
  std::vector<double> ratios = {0, 0.03, 0.1, 0.3, 0.7, 1, 1.7, 5, 10};
  if (tier == Tier::full) ratios.insert(ratios.end(), {0.01, 0.02, 0.2, 0.5, 0.9, 1.1, 3, 30, 100});
  std::sort(ratios.begin(), ratios.end());
  StudyResult result;
  Figure figure{"largest-step",
                "Largest stable step of the damped oscillator",
                {"damping ratio", "1", Scale::log},
                {"largest stable omega h", "1", Scale::log},
                "Measured from step matrices. Methods that are implicit in the elastic forces have "
                "no limit and no curve; A and B share one."};
  Table heavy(
      "method [1]; largest stable omega h [1]; exponent in the damping ratio [1]; |exponent + 1| "
      "[1]");
  double done = 0;
  for (const Integrator& integrator : integrators()) {
    progress(done++ / double(integrators().size()));
    if (integrator.family == Family::fully_implicit) {
      result.findings.push_back(unlimited_finding(subject, integrator));
    } else {
      const Table row = limit_row(subject, integrator, ratios);
      result.findings.push_back(limit_finding(integrator, row));
      if (integrator.family == Family::fully_explicit) add_heavy(integrator, row, heavy);
      Curve curve{std::string(integrator.name)};
      for (size_t i = 0; i < row.rows(); ++i)
        if (row.numbers("damping ratio")[i] > 0)
          curve.point(row.numbers("damping ratio")[i], row.numbers("largest stable omega h")[i]);
      figure.curves.push_back(std::move(curve));
      if (!(known_limit(integrator, 0) > 0))
        result.findings.push_back(undamped_growth(subject, integrator));
    }
    for (const char* mapped : {"A", "C", "RK4", "BDF2"})
      if (integrator.name == mapped)
        result.maps.push_back(radius_map(subject, integrator, tier == Tier::quick ? 3 : 10));
  }
  result.findings.push_back(heavy_finding(std::move(heavy)));
  result.figures.push_back(std::move(figure));
  return result;
}

}  // namespace

Study stability_oscillator_study() {
  return {"stability-oscillator",
          "On the damped oscillator schemes A and B are stable up to 2/omega whatever the damping, "
          "and C up to longer steps the stronger the damping; heavy damping shortens the stable "
          "step of explicit methods in proportion, and fully implicit ones have no limit.",
          {"limit-is-as-derived", "undamped-motion-grows", "heavy-damping-shortens-explicit-steps",
           "has-no-limit"},
          "BMF03 section 3",
          "One corner of a hinge moves across its plane, three are held: an oscillator whose "
          "frequency and damping can be worked out by hand. Two unit disturbances, stepped once, "
          "give the matrix of a method's step (four for BDF2, which looks back two states). "
          "Bisection finds the step at which its spectral radius exceeds 1, and that step is "
          "compared with the method's known limit.",
          run_stability_oscillator};
}

}  // namespace foldproof
