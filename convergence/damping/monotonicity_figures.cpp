#include "convergence/damping/monotonicity.h"

#include <cmath>

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

Figure sheet_figure(const Subject& subject, const DampedMotions& motions, Tier tier) {
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

}  // namespace

std::vector<Figure> monotonicity_figures(const Subject& subject, const DampedMotions& motions,
                                         Tier tier) {
  return {first_step_figure(subject, motions), distance_figure(subject, motions),
          history_figure(subject, motions.triangle, shown_of_triangle()),
          history_figure(subject, motions.hinge, shown_of_hinge()),
          sheet_figure(subject, motions, tier)};
}

}  // namespace foldproof
