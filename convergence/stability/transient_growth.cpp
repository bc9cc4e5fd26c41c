// transient-growth: how far a stable scheme can carry a disturbance before it decays, in the
// norm of the energy.
#include <cmath>

#include "convergence/order.h"
#include "convergence/ranges.h"
#include "convergence/stability/step_matrix.h"
#include "convergence/stability/studies.h"
#include "verification/oracles/exact_solutions.h"
#include "verification/oracles/stability.h"

namespace foldproof {

namespace {

// steps looked ahead; the largest growth comes within a period of the slowest
constexpr int powers = 60;

const std::vector<std::string>& schemes() {
  static const std::vector<std::string> names = {"A", "B", "C"};
  return names;
}

// ---- one oscillator: a = h c/2 = zeta omega h

double oscillator_growth(const Subject& subject, const std::string& scheme, double omega_h,
                         double a) {
  const SteppedMotion of = stepped_motion(subject, hinge_oscillator(a / omega_h), scheme);
  const double h = omega_h / of.motion.omega0;
  return transient_growth(step_matrix(of, {h, h}), powers);
}

double derived_growth(const std::string& scheme, double omega_h, double a) {
  const oracles::Oscillator oscillator{1, 2 * a / omega_h, 0, 0};
  return transient_growth(oracles::step_matrix(derived_scheme(scheme), oscillator, omega_h),
                          powers);
}

/// Growth of one scheme over damping (a) and step (omega h).
struct GrowthTable {
  std::vector<double> omega_h, a, growth;  // point by point
};

GrowthTable growth_table(const Subject& subject, const std::string& scheme) {
  GrowthTable table;
  for (const double omega_h : {0.1, 0.5, 1.0, 1.5, 1.9, 1.99})
    for (const double a : geometric_range(0.01, 1000, 16)) {
      table.omega_h.push_back(omega_h);
      table.a.push_back(a);
      table.growth.push_back(oscillator_growth(subject, scheme, omega_h, a));
    }
  return table;
}

std::vector<Column> columns_of(const GrowthTable& table) {
  return {{"omega h", "1", table.omega_h}, {"h c/2", "1", table.a}, {"growth", "1", table.growth}};
}

NamedFinding derived_finding(const std::string& scheme, const GrowthTable& table) {
  Worst worst;
  for (size_t i = 0; i < table.a.size(); ++i)
    worst.observe(
        std::abs(table.growth[i] / derived_growth(scheme, table.omega_h[i], table.a[i]) - 1));
  return {"transient-growth.growth-is-as-derived." + scheme,
          "The growth of a disturbance of the damped oscillator under scheme " + scheme +
              " is that of the derived matrix.",
          {{worst.value(), 1e-6, 0, "1",
            "entries are found to 1e-12 or so, and sixty powers of a stable matrix add up sixty "
            "such errors"},
           columns_of(table),
           "measured is the largest relative deviation"}};
}

/// Factor on the velocity in A's position update: h (1 - a). In the energy norm omega
/// h |1 - a| of it.
NamedFinding grows_with_damping(const GrowthTable& table) {
  Worst worst;
  std::vector<double> least;
  for (size_t i = 0; i < table.a.size(); ++i) {
    least.push_back(table.omega_h[i] * std::abs(table.a[i] - 1));
    worst.observe(least.back() / table.growth[i]);
  }
  std::vector<Column> columns = columns_of(table);
  columns.push_back({"omega h |h c/2 - 1|", "1", least});
  return {
      "transient-growth.A.grows-with-damping",
      "Though stable, scheme A carries a damped disturbance to omega h |h c/2 - 1| times its size "
      "at least, in the norm of the energy: in proportion to the damping and without bound.",
      {{worst.value(), 1, 1e-9, "1",
        "its explicit half step moves a particle by h (1 - h c/2) times its velocity: one entry of "
        "the step matrix, which no norm can be below"},
       std::move(columns),
       "measured is the largest omega h |h c/2 - 1| over the growth"}};
}

NamedFinding exponent_in_damping(const Subject& subject) {
  Convergence convergence;
  for (const double a : {3000.0, 300.0, 30.0}) {
    convergence.steps.push_back(a);
    convergence.errors.push_back(oscillator_growth(subject, "A", 1, a));
  }
  const Estimate deviation = order_deviation(convergence, 1, 2);
  return {
      "transient-growth.A.growth-is-proportional-to-damping",
      "The growth under scheme A is proportional to the damping where that is high.",
      {{deviation.value, 0.05, 0, "1", "h c/2 - 1 over h c/2 differs by a thirtieth at the lowest"},
       {{"h c/2", "1", convergence.steps}, {"growth", "1", convergence.errors}},
       "measured is |exponent - 1|, the larger of two pairs"}};
}

NamedFinding bounded_finding(const std::string& scheme, const GrowthTable& table) {
  Worst worst;
  std::vector<double> bounds;
  for (size_t i = 0; i < table.a.size(); ++i) {
    bounds.push_back(oracles::undamped_growth(table.omega_h[i]));
    worst.observe(table.growth[i] / bounds.back());
  }
  std::vector<Column> columns = columns_of(table);
  columns.push_back({"undamped growth", "1", bounds});
  return {"transient-growth.growth-is-bounded." + scheme,
          "Scheme " + scheme +
              " never carries a disturbance of the oscillator further than it does without "
              "damping, 1/sqrt(1 - (omega h/2)^2) of its size.",
          {{worst.value(), 1, 1e-9, "1",
            "the undamped leapfrog keeps v^2 + (1 - (omega h/2)^2) omega^2 x^2, and damping should "
            "take from it only"},
           std::move(columns),
           "measured is the largest growth over that of the undamped oscillator"}};
}

Map growth_map(const Subject& subject, const std::string& scheme, int fineness) {
  Map map{"growth-" + scheme,
          "Largest transient growth, scheme " + scheme,
          {"step times frequency, omega h", "1", Scale::linear},
          {"damping over a step, h c/2", "1", Scale::log},
          {},
          geometric_range(0.01, 100, 8 * fineness + 1),
          {},
          "largest norm of a power of the step",
          "1",
          Scale::log,
          "Norm of the energy, over the first sixty steps. All of these steps are stable.",
          {}};
  for (int i = 1; i <= 12 * fineness; ++i) map.x_values.push_back(1.98 * i / (12 * fineness));
  for (const double a : map.y_values)
    for (const double omega_h : map.x_values)
      map.values.push_back(oscillator_growth(subject, scheme, omega_h, a));
  return map;
}

// ---- a small sheet, whose stiffness and damping do not commute

/// Growth over damping at a step of 0.9 of the sheet's limit.
struct SheetGrowth {
  std::vector<double> damping;              // in multiples of a first guess of critical damping
  std::vector<std::vector<double>> growth;  // by scheme
};

constexpr double part_of_limit = 0.9;

SheetGrowth sheet_growth(const Subject& subject, int points) {
  SheetGrowth found{geometric_range(0.01, 100, points),
                    std::vector<std::vector<double>>(schemes().size())};
  for (const double damping : found.damping) {
    const SmallMotion motion = free_motion(clamped_sheet(0.3 * damping, 0.01 * damping), 50);
    const Eigen::MatrixXd stiffness = linear_forces(subject, motion).stiffness;
    const double h = part_of_limit * oracles::largest_leapfrog_step(stiffness).value;
    for (size_t i = 0; i < schemes().size(); ++i) {
      const Eigen::MatrixXd matrix =
          step_matrix(stepped_motion(subject, motion, schemes()[i]), {h, h});
      found.growth[i].push_back(
          transient_growth(in_energy_norm(matrix, stiffness, motion.omega0), powers));
    }
  }
  return found;
}

void add_sheet(const Subject& subject, int points, StudyResult& result) {
  const SheetGrowth found = sheet_growth(subject, points);
  const double bound = oracles::undamped_growth(2 * part_of_limit);
  Figure figure{"sheet",
                "Largest transient growth on a clamped sheet",
                {"damping constants over (0.3 N s/m, 0.01 N s)", "1", Scale::log},
                {"largest norm of a power of the step", "1", Scale::log},
                nan,
                "Norm of the energy; the step is 0.9 of the largest stable one.",
                {}};
  for (size_t i = 0; i < schemes().size(); ++i) {
    figure.curves.push_back({"scheme " + schemes()[i], found.damping, found.growth[i], nan, {}});
    if (schemes()[i] == "A") continue;
    Worst worst;
    for (const double growth : found.growth[i]) worst.observe(growth / bound);
    result.findings.push_back(
        {"transient-growth.sheet-growth-is-bounded." + schemes()[i],
         "On a sheet whose stiffness and damping do not commute, scheme " + schemes()[i] +
             " carries no disturbance further than the undamped sheet's fastest mode would be.",
         {{worst.value(), 1, 1e-6, "1",
           "1/sqrt(1 - (omega h/2)^2) of the fastest mode, without damping"},
          {{"damping", "1", found.damping}, {"growth", "1", found.growth[i]}},
          "measured is the largest growth over that bound"}});
  }
  const double first = found.growth[0].front(), last = found.growth[0].back();
  result.findings.push_back(
      {"transient-growth.A.sheet-growth-exceeds-tenfold",
       "On the sheet scheme A carries heavily damped disturbances to more than ten times what it "
       "does lightly damped ones, and ever further.",
       {{10 * first / last, 1, 0, "1", "an order of magnitude; the damping rises by four"},
        {{"damping", "1", found.damping}, {"growth", "1", found.growth[0]}},
        "measured is ten times the first growth over the last"}});
  result.figures.push_back(std::move(figure));
}

StudyResult run_transient_growth(const Subject& subject, Tier tier, const Progress& progress) {
  const bool quick = tier == Tier::quick;
  StudyResult result;
  Figure figure{
      "oscillator",
      "Largest transient growth of the damped oscillator at omega h = 1",
      {"damping over a step, h c/2", "1", Scale::log},
      {"largest norm of a power of the step", "1", Scale::log},
      nan,
      "Norm of the energy. Scheme A overshoots in proportion to the damping, B and C do not.",
      {}};
  double done = 0;
  for (const std::string& scheme : schemes()) {
    const GrowthTable table = growth_table(subject, scheme);
    result.findings.push_back(derived_finding(scheme, table));
    if (scheme == "A")
      result.findings.push_back(grows_with_damping(table));
    else
      result.findings.push_back(bounded_finding(scheme, table));
    Curve curve{"scheme " + scheme, {}, {}, nan, {}};
    for (size_t i = 0; i < table.a.size(); ++i)
      if (table.omega_h[i] == 1) curve.x.push_back(table.a[i]), curve.y.push_back(table.growth[i]);
    figure.curves.push_back(std::move(curve));
    result.maps.push_back(growth_map(subject, scheme, quick ? 2 : 8));
    progress(++done / 4);
  }
  result.findings.push_back(exponent_in_damping(subject));
  result.figures.push_back(std::move(figure));
  add_sheet(subject, quick ? 5 : 17, result);
  progress(1);
  return result;
}

}  // namespace

Study transient_growth_study() {
  return {"transient-growth",
          "For highly damped material scheme A, though stable, carries disturbances far beyond "
          "their size, in proportion to the damping; B and C never further than undamped motion.",
          "BMF03 section 3",
          "A step whose spectral radius is at most 1 may still amplify on the way, if its "
          "eigenvectors are not orthogonal. Measured is the largest norm of the first powers of "
          "the step matrix in the norm of the energy, in which exact motion never grows: on an "
          "oscillator, over step and damping, and on a small clamped sheet whose springs and "
          "hinges are damped out of proportion to their stiffness.",
          run_transient_growth};
}

}  // namespace foldproof
