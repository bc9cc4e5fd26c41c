// solve-tolerance: how loose the implicit solves may be before order and error suffer.

#include "convergence/work_precision/precision_problem.h"
#include "convergence/study.h"
#include "reference/dynamics/integrator.h"

namespace foldproof {

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double exact = 1e-14;        // tolerance that stands for exact solves
constexpr double of_the_cases = 1e-8;  // the shipped cases' usual tolerance
constexpr double order_kept = 0.1, error_kept = 0.1;

/// The damped sheet; its fastest mode is overdamped several times.
PrecisionProblem damped_sheet(Tier tier) {
  constexpr double relaxation = 0.02;  // s
  const int cells = tier == Tier::quick ? 6 : 12;
  return {"sheet",
          "the damped sheet",
          hanging_sheet(cells, relaxation),
          0.25,
          FirstOpinion::runge_kutta,
          "C",
          2,
          2,
          16,
          infinite};
}

std::vector<double> tolerances(Tier tier) {
  std::vector<double> all = {
      1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, of_the_cases, SolverSettings{}.tolerance, exact};
  if (tier == Tier::full)
    all = {1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12, exact};
  return all;
}

/// One scheme with one tolerance over all steps: errors over the motion, iterations of a solve in
/// the mean, operator applications.
struct TolerantRuns {
  std::string scheme;
  double tolerance, floor;
  Table runs;

  const std::vector<double>& errors() const { return runs.numbers("error"); }
  double order() const { return pair_orders(convergence_of(runs, "error")).back(); }
};

TolerantRuns runs_with(const Subject& subject, const PrecisionProblem& problem,
                       const PrecisionTruth& truth, const Integrator& scheme, double tolerance) {
  Scene scene = problem.scene;
  scene.integrator = std::string(scheme.name);
  scene.solver.tolerance = tolerance;
  const auto run_with = [&](int times) {
    const int steps = times * int(std::ceil(problem.end / truth.elastic_limit));
    const PlannedRun run = run_planned(subject, scene, {problem.end, steps, infinite, infinite});
    return std::tuple{problem.end / steps, largest_distance(run.last.x, truth.x) / truth.motion,
                      double(run.work.cg_iterations) / double(run.work.solves),
                      operator_applications(run.work)};
  };
  const std::vector<int> finer = {2, 4, 8};  // steps over those at the elastic limit
  return {scene.integrator, tolerance, truth.uncertainty,
          refine({{"step", "s"}, {"error", "1"}, {"iterations", "1"}, {"applications", "1"}}, finer,
                 run_with)};
}

/// How far looseness shifts the last pair's order, and the largest relative change of an error.
struct Harm {
  double order, error;
};

Harm harm_of(const TolerantRuns& loose, const TolerantRuns& tight) {
  Worst error;
  for (size_t i = 0; i < loose.errors().size(); ++i)
    error.observe(std::abs(loose.errors()[i] / tight.errors()[i] - 1));
  return {std::abs(loose.order() - tight.order()), error.value()};
}

/// All tolerances of one scheme, loose to tight; the last stands for exact solves.
using SchemeRuns = std::vector<TolerantRuns>;

NamedFinding order_is_kept(const std::vector<SchemeRuns>& schemes, double tolerance,
                           const std::string& whose) {
  Worst worst;
  Table orders(
      "scheme [1]; order [1]; order with exact solves [1]; largest relative change of an error "
      "[1]");
  for (const SchemeRuns& runs : schemes) {
    for (const TolerantRuns& run : runs) {
      if (run.tolerance != tolerance) continue;
      const Harm harm = harm_of(run, runs.back());
      orders.row(run.scheme, run.order(), runs.back().order(), harm.error);
      worst.observe(harm.order);
    }
  }
  const Verdict verdict{orders.rows() == 0 ? nan : worst.value(), order_kept / 10, 0, "1",
                        "a tenth of the error that the order studies allow an order, so that they "
                        "judge the scheme and not its solves"};
  return {"solve-tolerance." + whose + "-tolerance-preserves-the-order",
          "With the " + whose +
              " tolerance of the solves, the orders of A, B and C are those of exact solves.",
          {verdict, orders, "measured is the largest shift of the order of the two finest runs"}};
}

Table loosest(const std::vector<SchemeRuns>& schemes) {
  Table table(
      "scheme [1]; loosest tolerance [1]; order with it [1]; order with exact solves [1]; "
      "iterations a solve [1]; with exact solves [1]");
  for (const SchemeRuns& runs : schemes) {
    const TolerantRuns& tight = runs.back();
    size_t first = runs.size() - 1;
    for (; first > 0; --first) {
      const Harm harm = harm_of(runs[first - 1], tight);
      if (!(harm.order <= order_kept && harm.error <= error_kept)) break;
    }
    const TolerantRuns& loose = runs[first];
    table.row(tight.scheme, loose.tolerance, loose.order(), tight.order(),
              loose.runs.numbers("iterations").back(), tight.runs.numbers("iterations").back());
  }
  return {"loosest",
          "The loosest tolerance that keeps the order within 0.1 and every error within 10 % of "
          "exact solves",
          table};
}

Table all_runs(const std::vector<SchemeRuns>& schemes) {
  Table table(
      "scheme [1]; tolerance [1]; step [s]; error [%]; iterations a solve [1]; operator "
      "applications [1]");
  for (const SchemeRuns& scheme : schemes)
    for (const TolerantRuns& run : scheme)
      for (size_t i = 0; i < run.runs.rows(); ++i)
        table.row(run.scheme, run.tolerance, run.runs.numbers("step")[i], 100 * run.errors()[i],
                  run.runs.numbers("iterations")[i], run.runs.numbers("applications")[i]);
  return {"runs", "Error and cost with each tolerance", table};
}

/// A curve for each scheme and each of the coarsest and the finest step.
Figure figure_of(const std::vector<SchemeRuns>& schemes) {
  Figure figure{"error-against-tolerance",
                "Error against the tolerance of the solves",
                {"tolerance", "1", Scale::log},
                {"position error over the motion", "%", Scale::log},
                "Largest position error at the end, with the coarsest and with the finest step. "
                "Where a curve is level the step decides the error; where it rises the solves do."};
  const size_t finest = schemes.front().front().runs.rows() - 1;
  const std::array<std::pair<size_t, const char*>, 2> levels = {
      {{0, "coarsest"}, {finest, "finest"}}};
  for (const auto& [level, words] : levels) {
    for (const SchemeRuns& runs : schemes) {
      Curve curve{
          runs.front().scheme + ", " + words + " step", {}, {}, 100 * runs.front().floor, {}};
      for (const TolerantRuns& run : runs) curve.point(run.tolerance, 100 * run.errors()[level]);
      figure.curves.push_back(std::move(curve));
    }
  }
  return figure;
}

StudyResult run_solve_tolerance(const Subject& subject, Tier tier, const Progress& progress) {
  const PrecisionProblem problem = damped_sheet(tier);
  const PrecisionTruth truth = truth_of(subject, problem);
  std::vector<SchemeRuns> schemes;
  const std::vector<double> all = tolerances(tier);
  double done = 0;
  for (const Integrator& scheme : paper_schemes()) {
    SchemeRuns runs;
    for (double tolerance : all) {
      runs.push_back(runs_with(subject, problem, truth, scheme, tolerance));
      progress(++done / double(all.size() * paper_schemes().size()));
    }
    schemes.push_back(std::move(runs));
  }
  StudyResult result;
  result.findings = {order_is_kept(schemes, SolverSettings{}.tolerance, "default"),
                     order_is_kept(schemes, of_the_cases, "usual")};
  result.figures = {figure_of(schemes)};
  result.tables = {loosest(schemes), all_runs(schemes)};
  return result;
}

}  // namespace

Study solve_tolerance_study() {
  return {"solve-tolerance",
          "On a damped sheet, in steps of a half to an eighth of the elastic limit, the default "
          "tolerance of the solves leaves the observed order of A, B and C as exact solves do.",
          {"default-tolerance-preserves-the-order"},
          "BMF03 section 3",
          "How loose may a solve be? A damped sheet, whose fastest mode is damped several times "
          "critically, is run with A, B and C at half, a quarter and an eighth of the elastic "
          "limit while the relative residual at which conjugate gradients stop goes from a tenth "
          "down to rounding. Errors are against an extrapolated RK4, which solves nothing.",
          run_solve_tolerance};
}

}  // namespace foldproof
