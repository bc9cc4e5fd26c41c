// elastic-limit: the largest stable step of undamped motion, and how it shrinks with the cells.

#include "convergence/stability/stable_step.h"
#include "convergence/study.h"
#include "reference/dynamics/integrator.h"

namespace foldproof {

namespace {

/// Source of stiffness: springs or hinges, and the exponent of the cell width that
/// follows for the step.
struct Regime {
  std::string name, words;
  double stretch, bending;  // Y [N/m], ke [J]
  double exponent;          // of the width in the largest stable step
};

std::vector<Regime> regimes() {
  return {{"springs", "springs alone", 29, 0, 1}, {"bending", "bending alone", 0, 0.0071, 2}};
}

Regime both_regimes() { return {"both", "springs and bending", 29, 0.0071, nan}; }

Scene undamped_sheet(const Regime& regime, int cells) {
  Scene scene = flat_sheet(cells);
  if (regime.stretch > 0) scene.stretch = StretchMaterial{regime.stretch, 0, 1};
  if (regime.bending > 0) scene.bending = BendingMaterial{regime.bending, 0};
  return scene;
}

/// Limits of one regime over all meshes.
Table limits_of(const Subject& subject, const Regime& regime, const std::vector<int>& meshes) {
  return refine({{"width of a cell", "m"}, {"2/omega", "s"}, {"elastic limit", "s"}}, meshes,
                [&](int cells) {
                  const Scene scene = undamped_sheet(regime, cells);
                  return std::tuple{flat_side / cells, 2 / fastest_mode(subject, scene).omega,
                                    elastic_limit(build_system(scene), start_state(scene))};
                });
}

NamedFinding exponent_of(const Regime& regime, const Table& limits) {
  const Convergence exact = convergence_of(limits, "2/omega");
  Table evidence = with_columns(limits, {"width of a cell", "2/omega"});
  evidence.add({"exponent", "1", row_orders(exact)});
  const Verdict verdict =
      order_verdict(exact, regime.exponent, 1, 0.05,
                    "another whole exponent is off by 1; the border's effect on the fastest "
                    "mode vanishes as the number of cells grows");
  return {"elastic-limit.exponent." + regime.name,
          "With " + regime.words +
              ", the largest stable step is proportional to the cells' width to the power " +
              (regime.exponent == 1 ? "one." : "two."),
          {verdict, std::move(evidence), "measured is |exponent - expected| of the last pair"}};
}

NamedFinding bound_of(const Regime& regime, const Table& limits) {
  const std::vector<double>&exact = limits.numbers("2/omega"),
        &bounds = limits.numbers("elastic limit");
  std::vector<double> ratios;
  for (size_t i = 0; i < bounds.size(); ++i) ratios.push_back(bounds[i] / exact[i]);
  Table evidence = with_columns(limits, {"width of a cell"});
  evidence.add({"elastic limit over 2/omega", "1", ratios});
  const double worst = evidence.worst("elastic limit over 2/omega");
  const Verdict verdict{worst, 1, 0.01 * worst, "1",
                        "the bound on the frequency must not lie below the frequency"};
  return {"elastic-limit.bound-is-safe." + regime.name,
          "With " + regime.words +
              ", the reference's elastic limit is no longer than the largest stable step.",
          {verdict, std::move(evidence),
           "power iteration approaches omega from below, which errs towards passing; the "
           "uncertainty is the one percent within which runs confirm 2/omega"}};
}

/// On a flat sheet at rest springs act in its plane and hinges across it: neither
/// adds to the other.
NamedFinding smaller_of_both(const std::vector<Table>& alone, const Table& both) {
  Table limits = with_columns(both, {"width of a cell"});
  limits.add({"2/omega, both", "s", both.numbers("2/omega")});
  limits.add({"2/omega, springs alone", "s", alone[0].numbers("2/omega")});
  limits.add({"2/omega, bending alone", "s", alone[1].numbers("2/omega")});
  Worst worst;
  for (size_t i = 0; i < limits.rows(); ++i)
    worst.observe(std::abs(limits.numbers("2/omega, both")[i] /
                               std::min(limits.numbers("2/omega, springs alone")[i],
                                        limits.numbers("2/omega, bending alone")[i]) -
                           1));
  const Verdict verdict{worst.value(), 0.01, 0, "1",
                        "power iteration has found the frequencies to better than a hundredth"};
  return {"elastic-limit.both.is-the-smaller-of-the-two",
          "With springs and bending, the largest stable step is the smaller of the two: that of "
          "the springs on wide cells, that of bending on narrow ones.",
          {verdict, std::move(limits)}};
}

NamedFinding scheme_limit(const Subject& subject, const Regime& regime,
                          const Integrator& integrator) {
  Scene scene = undamped_sheet(regime, 6);
  scene.integrator = std::string(integrator.name);
  const double ratio =
      largest_stable_step(subject, scene, fastest_mode(subject, scene).omega, {0.8, 1.2, 8, 600});
  const Verdict verdict{std::abs(ratio - 1), 0.01, 0, "1",
                        "the bisection ends at a width of a sixth of that, and a run this long "
                        "tells growth rates that much beyond the limit"};
  const std::string name(integrator.name);
  return {"elastic-limit.is-two-over-omega." + regime.name + "." + name,
          "With " + regime.words + ", the largest stable step of scheme " + name +
              " on an undamped flat sheet is 2/omega.",
          {verdict, Table{{"largest stable step over 2/omega", "1"}}.with_row(ratio)}};
}

StudyResult run_elastic_limit(const Subject& subject, Tier tier, const Progress& progress) {
  std::vector<int> meshes = {4, 8, 16, 32};
  if (tier == Tier::full) meshes.push_back(64);
  StudyResult result;
  Figure figure{"largest-step",
                "Largest stable step of undamped motion",
                {"width of a cell", "m", Scale::log},
                {"2/omega", "s", Scale::log},
                "The springs' limit falls with the width, the hinges' with its square."};
  double done = 0;
  const double parts = 1 + double(regimes().size() * (1 + paper_schemes().size()));
  std::vector<Table> alone;
  for (const Regime& regime : regimes()) {
    const Table limits = limits_of(subject, regime, meshes);
    result.add({exponent_of(regime, limits), bound_of(regime, limits)});
    Curve exact = curve_of(regime.words, convergence_of(limits, "2/omega"));
    exact.slope = regime.exponent;
    figure.curves.push_back(std::move(exact));
    figure.curves.push_back(curve_of(regime.words + ", the solver's bound", limits,
                                     "width of a cell", "elastic limit"));
    alone.push_back(limits);
    progress(++done / parts);
    for (const Integrator& integrator : paper_schemes()) {
      result.findings.push_back(scheme_limit(subject, regime, integrator));
      progress(++done / parts);
    }
  }
  const Table both = limits_of(subject, both_regimes(), meshes);
  result.findings.push_back(smaller_of_both(alone, both));
  figure.curves.push_back(curve_of(both_regimes().words, both, "width of a cell", "2/omega"));
  progress(1);
  result.figures.push_back(std::move(figure));
  return result;
}

}  // namespace

Study elastic_limit_study() {
  return {"elastic-limit",
          "On an undamped flat sheet the largest stable step is 2/omega for schemes A, B and C; it "
          "is proportional to the cells' width where springs dominate, and to its square where "
          "bending does.",
          {"is-two-over-omega", "exponent", "both.is-the-smaller-of-the-two"},
          "BMF03 section 3",
          "A flat, free, undamped sheet is disturbed a little. Its fastest mode is found by power "
          "iteration on the elastic forces, the largest stable step of each scheme by bisection on "
          "runs that stay bounded or do not. The paper gives the limit as proportional to the "
          "width; hinges alone make it fall with the square.",
          run_elastic_limit};
}

}  // namespace foldproof
