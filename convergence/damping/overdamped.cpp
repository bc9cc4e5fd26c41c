// How every method comes to rest against stiffness that damping outweighs.
#include <cmath>

#include "convergence/damping/monotonicity.h"
#include "reference/dynamics/integrator.h"

namespace foldproof {

namespace {

constexpr double least_shown = 1e-6;  // of the way

Figure first_step_figure(const Subject& subject, const DampedMotions& motions) {
  Figure figure{
      "first-step",
      "First step of a damped motion",
      {"h c/2", "1", Scale::log},
      {"|first step| over the whole way", "1", Scale::log},
      "The exact motion covers 1 - exp(-h c) of its displacement. Above h c/2 = 1 the steps of A "
      "and RK2 go backwards. BDF2 is left out: its first step is another method's."};
  const std::vector<double> as = geometric_range(0.05, 40, 16);
  for (const Integrator& method : integrators()) {
    if (method.history > 1) continue;
    figure.curves.push_back(curve_over(std::string(method.name), as, [&](double a) {
      return std::abs(run_damped(subject, motions.triangle, method.name, a, 1).progress[1][0]);
    }));
  }
  figure.curves.push_back(curve_over("exact", as, [](double a) { return 1 - std::exp(-2 * a); }));
  return figure;
}

constexpr double shown_a = 10;

Figure distance_figure(const Subject& subject, const DampedMotions& motions) {
  Figure figure{"distance",
                "A damped motion at h c/2 = 10",
                {"step", "1"},
                {"distance from the exact place of rest, over the displacement", "1", Scale::log},
                "The exact motion is over before the first step ends. Explicit methods are "
                "unstable here; A comes to rest a hundred displacements away."};
  for (const Integrator& method : integrators()) {
    Curve curve{std::string(method.name)};
    const DampedRun run = run_damped(subject, motions.triangle, method.name, shown_a, 24);
    for (size_t n = 0; n < run.progress.size(); ++n) {
      const double distance = std::abs(run.progress[n][0] - 1);
      curve.point(double(n), distance > least_shown && distance < 1e6 ? distance : nan);
    }
    figure.curves.push_back(std::move(curve));
  }
  return figure;
}

/// Which methods a history shows, and what to say of them.
struct Shown {
  std::vector<std::string> methods;
  std::string caption;
};

Shown shown_of_triangle() {
  return {{"B", "C", "implicit-midpoint", "BDF2", "backward-euler"},
          "Methods whose motion stays bounded: B, C and the implicit midpoint rule oscillate about "
          "rest, BDF2 (started exactly) overshoots once, backward Euler approaches from one side."};
}

Shown shown_of_hinge() {
  return {{"B", "C", "linear-backward-euler"},
          "Methods whose solves all succeed; the table has the others. The hinge's damping falls "
          "as it unfolds: C, which takes the explicit part first, does not come back."};
}

Figure history_figure(const Subject& subject, const DampedMotion& motion, const Shown& shown) {
  Figure figure{"history-" + motion.name,
                "Coming to rest at h c/2 = 10: " + motion.words,
                {"step", "1"},
                {"displacement over the exact one", "1"},
                shown.caption};
  for (const std::string& method : shown.methods) {
    Curve curve{method};
    const DampedRun run = run_damped(subject, motion, method, shown_a, 16);
    for (size_t n = 0; n < run.progress.size(); ++n) curve.point(double(n), run.progress[n][0]);
    figure.curves.push_back(std::move(curve));
  }
  return figure;
}

Figure overshoot_figure(const Subject& subject, const DampedMotions& motions, Tier tier) {
  Figure figure{"sheet",
                "Overshoot on a damped sheet",
                {"h c/2 of the fastest mode", "1", Scale::log},
                {"largest overshoot or way back of a mode, over its way", "1", Scale::log},
                "All modes in the plane of the sheet move at first, and damping stops them. "
                "Backward Euler neither overshoots nor turns back at any step, A, B, C and the "
                "implicit midpoint rule neither below 1. BDF2 is started exactly."};
  const std::vector<double> as = geometric_range(0.1, 100, tier == Tier::quick ? 10 : 25);
  for (const std::string method : {"A", "B", "C", "BDF2", "implicit-midpoint"}) {
    figure.curves.push_back(curve_over(method, as, [&](double a) {
      const double wrong =
          worst_overshoot_or_reversal(run_damped(subject, motions.sheet, method, a, 20));
      return wrong > least_shown && wrong < 1e5 ? wrong : nan;
    }));
  }
  return figure;
}

constexpr double most_shown = 1e6;  // ways
constexpr double turning = 1e-5;    // of the way
constexpr const char* why_turning =
    "displacements are nanometres: positions round by 1e-8 of them, nonlinearity is 1e-7; a method "
    "that overshoots does so by a large part of the displacement";

/// How far a velocity points away from rest at most, or rises again, over that at the start.
double velocity_misconduct(const DampedRun& run) {
  Worst worst;
  for (size_t n = 1; n < run.speed.size(); ++n)
    for (size_t i = 0; i < run.speed[n].size(); ++i) {
      worst.observe(-run.speed[n][i]);
      worst.observe(run.speed[n][i] - run.speed[n - 1][i]);
    }
  return worst.value();
}

/// The sheet at each of these steps, a = h c/2: positions and velocities, each by the worse of
/// overshoot and way back.
Table sheet_at_steps(const Subject& subject, const DampedMotion& sheet, const std::string& method,
                     const std::vector<double>& as, int steps) {
  Table rows("h c/2 [1]; positions [displacements]; velocities [of the start's]");
  for (const double a : as) {
    const DampedRun run = run_damped(subject, sheet, method, a, steps);
    rows.row(a, worst_overshoot_or_reversal(run), velocity_misconduct(run));
  }
  return rows;
}

/// The worst of positions and velocities alike.
double worst_of_both(const Table& rows) {
  Worst worst;
  worst.observe(rows.worst("positions"));
  worst.observe(rows.worst("velocities"));
  return worst.value();
}

NamedFinding sheet_is_monotone(const Subject& subject, const DampedMotion& sheet,
                               const std::string& method) {
  const Table rows = sheet_at_steps(subject, sheet, method, {0.7, 4.3, 25.0, 400.0}, 30);
  return {"monotonicity.overdamped-sheet.monotone." + method,
          "On an overdamped sheet with stiffness neither a position nor a velocity overshoots or "
          "turns back at any step under " +
              method + ".",
          {{worst_of_both(rows), turning, 0, "of the displacement or of the speed", why_turning},
           rows}};
}

NamedFinding sheet_is_thrown_back(const Subject& subject, const DampedMotion& sheet) {
  const Table rows = sheet_at_steps(subject, sheet, "A", {10}, 12);
  return {"monotonicity.overdamped-sheet.overshoots.A",
          "On an overdamped sheet with stiffness scheme A throws a mode back by more than fifty "
          "times its displacement at h c/2 = 10, a step at which it is stable.",
          {{50 / rows.numbers("positions").front(), 1, 0, "1",
            "measured is fifty over the displacement back; if half of the displacement decays "
            "fast, a^2 - a = 90 is derived for the first step"},
           rows}};
}

NamedFinding sheet_is_bounded(const Subject& subject, const DampedMotion& sheet,
                              const std::string& scheme) {
  const Table rows = sheet_at_steps(subject, sheet, scheme, {0.7, 2.2, 4.3, 7.0, 12.0}, 30);
  return {"monotonicity.overdamped-sheet.overshoot-is-bounded." + scheme,
          "On an overdamped sheet with stiffness scheme " + scheme +
              ", in steps up to h c/2 = 12, overshoots or turns back by less than the displacement "
              "in positions, and by less than twice the starting speed in velocities.",
          {{worst_of_both(rows), 2, 0, "displacements or speeds",
            "derived without stiffness: a velocity is multiplied by (1 - a)/(1 + a) > -1, so it "
            "changes by less than twice its size; the part of a position that decays fast "
            "overshoots by less than itself"},
           rows}};
}

NamedFinding sheet_swings(const Subject& subject, const DampedMotion& sheet,
                          const std::string& scheme) {
  const Table rows = sheet_at_steps(subject, sheet, scheme, {2.2, 4.3, 7.0, 12.0}, 30);
  Worst worst;
  for (const double velocity : rows.numbers("velocities")) worst.observe(0.1 / velocity);
  return {"monotonicity.overdamped-sheet.velocity-changes-sign." + scheme,
          "On an overdamped sheet with stiffness velocities change sign under " + scheme +
              " at steps with h c/2 > 2, by more than a tenth of those at the start.",
          {{worst.value(), 1, 0, "1",
            "each reversal must reach a tenth of the starting velocity: measured is a tenth over "
            "the smallest of the four"},
           rows}};
}

NamedFinding hinge_closes_monotonically(const Subject& subject, const DampedMotion& hinge,
                                        const std::string& method) {
  Table rows("motion [1]; h c/2 [1]; overshoot or way back [displacements]");
  for (const double a : {0.2, 0.7, 4.3, 25.0, 110.0, 400.0}) {
    const DampedRun run = run_damped(subject, hinge, method, a, 40);
    const double wrong = run.work.unfinished_solves == 0 ? worst_overshoot_or_reversal(run) : nan;
    rows.row(hinge.name, a, wrong);
  }
  return {"monotonicity.closing-hinge-is-monotone." + method,
          "An overdamped hinge that closes by nearly two radians neither passes its rest angle nor "
          "turns back under " +
              method + ", at any step.",
          {{rows.worst("overshoot or way back"), 1e-7, 0, "of the displacement",
            "forty solves, each to 1e-11 of the momentum that the hinge would have at its fast "
            "rate, a thousand times its own"},
           rows,
           "A solve that did not finish would count as NaN."}};
}

// ---- what is shown

Figure sheet_figure(const std::string& name, const std::string& of) {
  return {
      name,
      "Overshoot on an overdamped sheet with stiffness: " + of,
      {"h c/2 of the fastest mode", "1", Scale::log},
      {"largest overshoot or way back of a mode, over its start", "1", Scale::log},
      "Every mode starts displaced and moving towards rest. All modes have at least four times the "
      "critical damping. Curves of methods that are monotone everywhere are empty and left out. A "
      "step beyond a method's limit ends its curve, or sends it up. BDF2 is started exactly."};
}

/// The values worth a marker, if there is any.
void add_curve(const std::string& method, const Table& rows, std::string_view column,
               Figure& figure) {
  Curve curve = curve_of(method, rows, "h c/2", column);
  bool any = false;
  for (double& value : curve.y) {
    if (!(value > least_shown && value < most_shown)) value = nan;
    any |= std::isfinite(value);
  }
  if (any) figure.curves.push_back(std::move(curve));
}

void add_figures(const Subject& subject, const DampedMotion& sheet, Tier tier,
                 StudyResult& result) {
  Figure positions = sheet_figure("overdamped-positions", "positions"),
         velocities = sheet_figure("overdamped-velocities", "velocities");
  for (const Integrator& method : integrators()) {
    const Table rows = sheet_at_steps(subject, sheet, std::string(method.name),
                                      geometric_range(0.1, 100, tier == Tier::quick ? 9 : 21), 20);
    add_curve(std::string(method.name), rows, "positions", positions);
    add_curve(std::string(method.name), rows, "velocities", velocities);
  }
  result.figures.push_back(std::move(positions));
  result.figures.push_back(std::move(velocities));
}

Table closing_table(const Subject& subject, const DampedMotion& hinge) {
  Table table(
      "method [1]; h c/2 [1]; overshoot or way back [displacements]; Newton iterations [a step]; "
      "unfinished solves [1]");
  for (const Integrator& integrator : integrators())
    for (const double a : {0.7, 4.3, 25.0, 400.0}) {
      if (integrator.family != Family::fully_implicit) continue;
      const DampedRun run = run_damped(subject, hinge, integrator.name, a, 40);
      table.row(integrator.name, a, worst_overshoot_or_reversal(run),
                double(run.work.newton_iterations) / double(run.speed.size() - 1),
                run.work.unfinished_solves);
    }
  return {"closing-hinge",
          "Fully implicit methods on an overdamped hinge that closes by nearly two radians", table};
}

}  // namespace

void add_overdamped(const Subject& subject, Tier tier, StudyResult& result) {
  const DampedMotion sheet = overdamped_sheet(tier == Tier::quick ? 2 : 4), hinge = closing_hinge();
  for (const std::string method : {"backward-euler", "linear-backward-euler"})
    result.findings.push_back(sheet_is_monotone(subject, sheet, method));
  result.findings.push_back(sheet_is_thrown_back(subject, sheet));
  for (const std::string scheme : {"B", "C"}) {
    result.add({sheet_is_bounded(subject, sheet, scheme), sheet_swings(subject, sheet, scheme)});
  }
  result.add({sheet_swings(subject, sheet, "implicit-midpoint"),
              hinge_closes_monotonically(subject, hinge, "backward-euler")});
  add_figures(subject, sheet, tier, result);
  result.tables.push_back(closing_table(subject, hinge));
}

std::vector<Figure> monotonicity_figures(const Subject& subject, const DampedMotions& motions,
                                         Tier tier) {
  return {first_step_figure(subject, motions), distance_figure(subject, motions),
          history_figure(subject, motions.triangle, shown_of_triangle()),
          history_figure(subject, motions.hinge, shown_of_hinge()),
          overshoot_figure(subject, motions, tier)};
}

}  // namespace foldproof
