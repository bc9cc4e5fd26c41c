// transient-growth: how far a stable scheme can carry a disturbance before it decays, in the
// norm of the energy.

#include "convergence/stability/step_matrix.h"
#include "convergence/study.h"
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

/// Growth of one scheme over step and damping, point by point.
Table growth_table(const Subject& subject, const std::string& scheme) {
  Table table("omega h [1]; h c/2 [1]; growth [1]");
  for (const double omega_h : {0.1, 0.5, 1.0, 1.5, 1.9, 1.99})
    for (const double a : geometric_range(0.01, 1000, 16))
      table.row(omega_h, a, oscillator_growth(subject, scheme, omega_h, a));
  return table;
}

/// Another column, computed from omega h and h c/2.
template <class Value>
void add_column(Table& table, const std::string& name, const Value& value) {
  const std::vector<double>&omega_h = table.numbers("omega h"), &a = table.numbers("h c/2");
  std::vector<double> values;
  for (size_t i = 0; i < a.size(); ++i) values.push_back(value(omega_h[i], a[i]));
  table.add({name, "1", std::move(values)});
}

NamedFinding derived_finding(const std::string& scheme, const Table& table) {
  Table derived = table;
  add_column(derived, "derived",
             [&](double omega_h, double a) { return derived_growth(scheme, omega_h, a); });
  return {"transient-growth.growth-is-as-derived." + scheme,
          "The growth of a disturbance of the damped oscillator under scheme " + scheme +
              " is that of the derived matrix.",
          {{largest_deviation(derived, "growth", "derived"), 1e-6, 0, "1",
            "entries are found to 1e-12 or so, and sixty powers of a stable matrix add up sixty "
            "such errors"},
           table,
           "measured is the largest relative deviation"}};
}

/// Factor on the velocity in A's position update: h (1 - a). In the energy norm omega
/// h |1 - a| of it.
NamedFinding grows_with_damping(Table table) {
  add_column(table, "omega h |h c/2 - 1|",
             [](double omega_h, double a) { return omega_h * std::abs(a - 1); });
  const double worst = largest_ratio(table, "omega h |h c/2 - 1|", "growth");
  return {"transient-growth.A.grows-with-damping",
          "Though stable, scheme A amplifies a damped disturbance by at least omega h |h c/2 - 1| "
          "in the energy norm: in proportion to the damping.",
          {{worst, 1, 1e-9, "1",
            "its explicit half step moves a particle by h (1 - h c/2) times its velocity: that is "
            "one entry of the step matrix, and no norm of the matrix can be below it"},
           std::move(table),
           "measured is the largest omega h |h c/2 - 1| over the growth"}};
}

NamedFinding exponent_in_damping(const Subject& subject) {
  Table growths{{"h c/2", "1"}, {"growth", "1"}};
  for (const double a : {3000.0, 300.0, 30.0})
    growths.row(a, oscillator_growth(subject, "A", 1, a));
  return {"transient-growth.A.growth-is-proportional-to-damping",
          "The growth under scheme A is proportional to the damping where that is high.",
          {order_verdict(convergence_of(growths, "growth"), 1, 2, 0.05,
                         "h c/2 - 1 over h c/2 differs by a thirtieth at the lowest"),
           growths, "measured is |exponent - 1|, the larger of two pairs"}};
}

NamedFinding bounded_finding(const std::string& scheme, Table table) {
  add_column(table, "undamped growth",
             [](double omega_h, double) { return oracles::undamped_growth(omega_h); });
  const double worst = largest_ratio(table, "growth", "undamped growth");
  return {"transient-growth.growth-is-bounded." + scheme,
          "Scheme " + scheme +
              " never amplifies a disturbance of the oscillator more than it does without damping, "
              "by 1/sqrt(1 - (omega h/2)^2).",
          {{worst, 1, 1e-9, "1",
            "the undamped leapfrog keeps v^2 + (1 - (omega h/2)^2) omega^2 x^2, and damping should "
            "take from it only"},
           std::move(table),
           "measured is the largest growth over that of the undamped oscillator"}};
}

Map growth_map(const Subject& subject, const std::string& scheme, int fineness) {
  Map map{"growth-" + scheme,
          "Largest transient growth, scheme " + scheme,
          {"step times frequency, omega h", "1"},
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

constexpr double part_of_limit = 0.9;

/// Growth of each scheme at a step of 0.9 of the sheet's limit, over damping in multiples of a
/// first guess of critical damping.
Table sheet_growth(const Subject& subject, int points) {
  Table found("damping [1]; A [1]; B [1]; C [1]");
  for (const double damping : geometric_range(0.01, 100, points)) {
    const SmallMotion motion = free_motion(clamped_sheet(0.3 * damping, 0.01 * damping), 50);
    const Eigen::MatrixXd stiffness = linear_forces(subject, motion).stiffness;
    const double h = part_of_limit * oracles::largest_leapfrog_step(stiffness).value;
    const auto growth = [&](const char* scheme) {
      const Eigen::MatrixXd matrix = step_matrix(stepped_motion(subject, motion, scheme), {h, h});
      return transient_growth(in_energy_norm(matrix, stiffness, motion.omega0), powers);
    };
    found.row(damping, growth("A"), growth("B"), growth("C"));
  }
  return found;
}

/// Growth of one scheme over damping.
Table growth_of(const Table& found, const std::string& scheme) {
  Table growth = with_columns(found, {"damping"});
  growth.add({"growth", "1", found.numbers(scheme)});
  return growth;
}

NamedFinding sheet_bound(const Table& found, const std::string& scheme) {
  const double bound = oracles::undamped_growth(2 * part_of_limit);
  return {"transient-growth.sheet-growth-is-bounded." + scheme,
          "On a sheet whose stiffness and damping do not commute, scheme " + scheme +
              " amplifies no disturbance more than the undamped sheet's fastest mode.",
          {{found.worst(scheme) / bound, 1, 1e-6, "1",
            "1/sqrt(1 - (omega h/2)^2) of the fastest mode, without damping"},
           growth_of(found, scheme),
           "measured is the largest growth over that bound"}};
}

NamedFinding sheet_excess(const Table& found) {
  const double first = found.numbers("A").front(), last = found.numbers("A").back();
  return {"transient-growth.A.sheet-growth-exceeds-tenfold",
          "On the sheet scheme A amplifies heavily damped disturbances more than ten times as much "
          "as lightly damped ones.",
          {{10 * first / last, 1, 0, "1", "an order of magnitude; the damping rises by four"},
           growth_of(found, "A"),
           "measured is ten times the first growth over the last"}};
}

void add_sheet(const Subject& subject, int points, StudyResult& result) {
  const Table found = sheet_growth(subject, points);
  Figure figure{"sheet",
                "Largest transient growth on a clamped sheet",
                {"damping constants over (0.3 N s/m, 0.01 N s)", "1", Scale::log},
                {"largest norm of a power of the step", "1", Scale::log},
                "Norm of the energy; the step is 0.9 of the largest stable one."};
  for (const std::string& scheme : schemes()) {
    figure.curves.push_back(curve_of("scheme " + scheme, found, "damping", scheme));
    if (scheme != "A") result.findings.push_back(sheet_bound(found, scheme));
  }
  result.findings.push_back(sheet_excess(found));
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
      "Norm of the energy. Scheme A overshoots in proportion to the damping, B and C do not."};
  double done = 0;
  for (const std::string& scheme : schemes()) {
    const Table table = growth_table(subject, scheme);
    result.findings.push_back(derived_finding(scheme, table));
    if (scheme == "A")
      result.findings.push_back(grows_with_damping(table));
    else
      result.findings.push_back(bounded_finding(scheme, table));
    Curve curve{"scheme " + scheme};
    for (size_t i = 0; i < table.rows(); ++i)
      if (table.numbers("omega h")[i] == 1)
        curve.point(table.numbers("h c/2")[i], table.numbers("growth")[i]);
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
          "Under high damping scheme A, though stable, amplifies disturbances of an oscillator in "
          "proportion to the damping; on it and on a sheet B and C never amplify them more than "
          "undamped motion does.",
          {"A.grows-with-damping", "A.growth-is-proportional-to-damping",
           "A.sheet-growth-exceeds-tenfold", "growth-is-bounded", "sheet-growth-is-bounded"},
          "BMF03 section 3",
          "A step whose spectral radius is at most 1 may still amplify a disturbance on the way, "
          "if its eigenvectors are not orthogonal. Measured is the largest norm of the first "
          "powers of the step matrix in the norm of the energy, in which exact motion never grows: "
          "on an oscillator, over step and damping, and on a small clamped sheet whose springs and "
          "hinges are damped out of proportion to their stiffness.",
          run_transient_growth};
}

}  // namespace foldproof
