#include "convergence/integrators/time_order.h"

#include <algorithm>
#include <cmath>

#include "reference/dynamics/integrator.h"
#include "verification/specimens/random.h"

namespace foldproof {

namespace {

constexpr int pairs_judged = 3;
constexpr double bound = 0.1;
constexpr const char* why_bound =
    "chosen bound on |order - expected| over the last three pairs: another order is off by 1, and "
    "the evidence shows the effect of the error's next term, pair by pair";

std::string in_words(int order) {
  const std::array<std::string, 5> words = {"zeroth", "first", "second", "third", "fourth"};
  return words.at(size_t(order));
}

/// The errors of one integrator with one pattern over all levels: mean step, steps, errors.
struct Run {
  Integrator integrator;
  StepPattern pattern;
  Table levels;
  double floor;  // m, m/s

  std::string label() const {
    return std::string(integrator.name) + ", " + std::string(pattern.name);
  }
};

double largest_difference(const PerParticle3& p, const PerParticle3& q) {
  Worst worst;
  for (Eigen::Index i = 0; i < p.size(); ++i) worst.observe(std::abs(p.data()[i] - q.data()[i]));
  return worst.value();
}

State end_of(const Subject& subject, PreparedScene& prepared, const Scene& scene,
             const std::vector<double>& steps) {
  History history(start_state(scene), 2);
  Work uncounted;
  for (double h : steps) history.advance(subject.step(prepared, history.past(), h, uncounted));
  return history.now();
}

/// Tells the progress of many runs by the steps taken.
struct Meter {
  const Progress& progress;
  double total, done = 0;

  void add(double steps) {
    done += steps;
    progress(done / total);
  }
};

Run errors_of(const Subject& subject, const OrderProblem& problem, const ObservedMethod& method,
              const StepPattern& pattern, Meter& meter) {
  Scene scene = problem.scene;
  scene.integrator = std::string(method.integrator.name);
  const auto prepared = require_offered(subject.prepare, "prepare")(scene);
  const auto level = [&](int count) {
    const State end = end_of(subject, *prepared, scene, steps_of(pattern, problem.end, count));
    meter.add(count);
    return std::tuple{problem.end / count, count, largest_difference(end.x, problem.truth.x),
                      largest_difference(end.v, problem.truth.v)};
  };
  return {method.integrator, pattern,
          refine({{"mean step", "s"}, {"steps", "1"}, {"error in x", "m"}, {"error in v", "m/s"}},
                 doubling_range(method.coarsest, method.coarsest << (method.levels - 1)), level),
          problem.uncertainty};
}

std::vector<Run> all_runs(const Subject& subject, const OrderProblem& problem,
                          const Progress& progress) {
  require_offered(subject.step, "step");
  double steps = 0;
  for (const ObservedMethod& method : problem.methods)
    steps += double(method.patterns.size()) * method.coarsest * (std::pow(2, method.levels) - 1);
  Meter meter{progress, steps};
  std::vector<Run> all;
  for (const ObservedMethod& method : problem.methods)
    for (const StepPattern& pattern : method.patterns)
      all.push_back(errors_of(subject, problem, method, pattern, meter));
  return all;
}

/// Which of the two quantities of a run is meant.
struct Quantity {
  std::string name, words, unit;

  std::string column() const { return "error in " + name; }
  Convergence of(const Run& run) const {
    Convergence errors = convergence_of(run.levels, column());
    errors.floor = run.floor;
    return errors;
  }
};

std::array<Quantity, 2> quantities() {
  return {{{"x", "positions", "m"}, {"v", "velocities", "m/s"}}};
}

/// The levels whose errors the reference solution can tell from its own: at least four, that three
/// pairs can be judged.
Convergence above_floor(const Convergence& errors) {
  constexpr int least = pairs_judged + 1;
  const size_t levels = size_t(std::max(least, levels_above_floor(errors, 50)));
  Convergence result = errors;
  result.steps.resize(std::min(levels, errors.steps.size()));
  result.errors.resize(result.steps.size());
  return result;
}

NamedFinding finding_of(const OrderProblem& problem, const Run& run, const Quantity& quantity) {
  const Convergence errors = quantity.of(run);
  Table evidence = with_columns(run.levels, {"mean step", "steps", quantity.column()});
  evidence.add({"order of the pair", "1", row_orders(errors)});
  Finding finding{
      order_verdict(above_floor(errors), run.integrator.order, pairs_judged, bound, why_bound),
      std::move(evidence),
      "measured is the largest |order - expected| over the last three pairs of errors "
      "that exceed fifty times the reference's uncertainty, where the table of "
      "integrators states what is expected"};
  const std::string name(run.integrator.name);
  return {problem.study + "." + name + "." + std::string(run.pattern.name) + "." + quantity.name,
          name + " is " + in_words(run.integrator.order) + " order in the " + quantity.words +
              " of " + problem.description + " with " + std::string(run.pattern.words) + ".",
          std::move(finding)};
}

/// Finding for "second order only while the step is constant": B with both patterns of
/// variable steps.
NamedFinding newmark_with_variable_steps(const OrderProblem& problem,
                                         const std::vector<Run>& runs) {
  constexpr double second = 2;  // the paper's claim, regardless of the table
  Worst deviation, uncertainty;
  Table orders("steps [1]; error in [1]; order of the last pair [1]");
  for (const Run& run : runs) {
    if (run.integrator.name != "B" || run.pattern.name == "constant") continue;
    for (const Quantity& quantity : quantities()) {
      const Convergence errors = quantity.of(run);
      const Estimate one = order_deviation(above_floor(errors), second, pairs_judged);
      deviation.observe(one.value);
      uncertainty.observe(one.uncertainty);
      orders.row(run.pattern.name, quantity.name, pair_orders(errors).back());
    }
  }
  Finding finding{
      {orders.rows() == 0 ? nan : deviation.value(), bound, uncertainty.value(), "1", why_bound},
      orders,
      "B is a one-step map with a local error of third order, so its order does not need a "
      "constant step"};
  return {problem.study + ".B-is-second-order-with-variable-steps",
          "Scheme B is second order in x and v with alternating and with random steps, too.",
          std::move(finding)};
}

/// Which methods a figure shows.
struct Selection {
  std::string prefix, words;
  bool (*shows)(const Run& run);
};

std::vector<Selection> selections() {
  const auto of_paper = [](const Run& run) { return run.integrator.family == Family::mixed; };
  const auto other = [](const Run& run) {
    return run.integrator.family != Family::mixed && run.pattern.name == "constant";
  };
  return {{"", "schemes A, B, C", of_paper},
          {"compared-", "the methods compared with, constant steps", other}};
}

Figure figure_of(const OrderProblem& problem, const std::vector<Run>& runs,
                 const Quantity& quantity, const Selection& selection) {
  const bool of_paper = selection.prefix.empty();
  Figure figure{
      selection.prefix + "errors-in-" + quantity.name,
      "Error in the " + quantity.words + " of " + problem.description + ": " + selection.words,
      {"mean step", "s", Scale::log},
      {"largest error in " + quantity.name, quantity.unit, Scale::log},
      of_paper ? 2 : nan,
      "Largest error of any coordinate at the end of the motion. The floor is the uncertainty of "
      "the reference solution.",
      {}};
  for (const Run& run : runs) {
    if (!selection.shows(run)) continue;
    const Convergence errors = quantity.of(run);
    const std::string label = of_paper ? run.label() : std::string(run.integrator.name);
    figure.curves.push_back(
        {label, errors.steps, errors.errors, errors.floor, pair_orders(errors)});
  }
  return figure;
}

Table table_of(const std::vector<Run>& runs) {
  Table table(
      "scheme [1]; steps [1]; error in [1]; order fitted to all levels [1]; order of the last pair "
      "[1]; asymptotic from mean step [s]; levels ten times above the floor [1]");
  for (const Run& run : runs)
    for (const Quantity& quantity : quantities()) {
      const Convergence errors = quantity.of(run);
      const std::vector<double> orders = pair_orders(errors);
      const int first = asymptotic_from(orders, run.integrator.order, bound);
      table.row(run.integrator.name, run.pattern.name, quantity.name, fitted_order(errors),
                orders.back(), first < int(orders.size()) ? errors.steps[size_t(first)] : nan,
                levels_above_floor(errors, 10));
    }
  return {"orders", "Observed orders", table};
}

}  // namespace

namespace {

/// Eight steps, at most ratio:1, fixed once for all.
std::vector<double> random_steps(double ratio) {
  constexpr int length = 8;
  std::vector<double> steps;
  Random random(20030726);
  double sum = 0;
  for (int i = 0; i < length; ++i) {
    steps.push_back(std::pow(ratio, random.uniform(0, 1)));
    sum += steps.back();
  }
  for (double& step : steps) step *= length / sum;
  return steps;
}

}  // namespace

std::vector<StepPattern> step_patterns() {
  return {{"constant", "constant steps", {1}},
          {"alternating", "steps alternating 9:1", {1.8, 0.2}},
          {"random", "random steps", random_steps(9)}};
}

std::vector<StepPattern> gentle_step_patterns() {
  return {{"constant", "constant steps", {1}},
          {"gently-alternating", "steps alternating 2:1", {4. / 3, 2. / 3}},
          {"gently-random", "random steps, at most 2:1", random_steps(2)}};
}

std::vector<ObservedMethod> paper_methods(int coarsest, int levels) {
  std::vector<ObservedMethod> methods;
  for (const Integrator& integrator : integrators())
    if (integrator.family == Family::mixed)
      methods.push_back({integrator, step_patterns(), coarsest, levels});
  return methods;
}

std::vector<double> steps_of(const StepPattern& pattern, double end, int count) {
  const int length = int(pattern.relative.size());
  if (!(count >= 1 && count % length == 0))
    throw InputError("step pattern '" + std::string(pattern.name) + "': " + std::to_string(count) +
                     " steps are no multiple of its " + std::to_string(length));
  std::vector<double> steps;
  for (int i = 0; i < count; ++i)
    steps.push_back(pattern.relative[size_t(i % length)] * end / count);
  return steps;
}

StudyResult time_order(const Subject& subject, const OrderProblem& problem,
                       const Progress& progress) {
  const std::vector<Run> runs = all_runs(subject, problem, progress);
  StudyResult result;
  for (const Run& run : runs)
    for (const Quantity& quantity : quantities())
      result.findings.push_back(finding_of(problem, run, quantity));
  result.findings.push_back(newmark_with_variable_steps(problem, runs));
  for (const Selection& selection : selections()) {
    if (std::none_of(runs.begin(), runs.end(), selection.shows)) continue;
    for (const Quantity& quantity : quantities())
      result.figures.push_back(figure_of(problem, runs, quantity, selection));
  }
  result.tables.push_back(table_of(runs));
  return result;
}

}  // namespace foldproof
