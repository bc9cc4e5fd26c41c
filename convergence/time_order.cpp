#include "convergence/time_order.h"

#include <cmath>
#include <limits>
#include <random>

#include "convergence/order.h"
#include "reference/dynamics/integrator.h"

namespace foldproof {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr int pairs_judged = 3;
constexpr double bound = 0.1;
constexpr const char* why_bound =
    "design bound on |order - expected| over the last three pairs: another order is off by 1, and the "
    "evidence "
    "shows, pair by pair, what the error's next term leaves";

std::string in_words(int order) {
  const std::array<std::string, 5> words = {"zeroth", "first", "second", "third", "fourth"};
  return words.at(size_t(order));
}

/// The errors of one integrator with one pattern over all levels.
struct Run {
  Integrator integrator;
  StepPattern pattern;
  std::vector<double> counts;  // steps of each level
  Convergence x, v;            // errors in m and m/s over the mean step in s

  std::string label() const { return std::string(integrator.name) + ", " + std::string(pattern.name); }
};

double largest_difference(const PerParticle3& p, const PerParticle3& q) {
  Worst worst;
  for (Eigen::Index i = 0; i < p.size(); ++i) worst.see(std::abs(p.data()[i] - q.data()[i]));
  return worst.value();
}

State end_of(const Subject& subject, Prepared& prepared, const Scene& scene,
             const std::vector<double>& steps) {
  State s = start_state(scene);
  Work uncounted;
  for (double h : steps) s = subject.step(prepared, s, h, uncounted);
  return s;
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

Run errors_of(const Subject& subject, const OrderProblem& problem, Run run, Meter& meter) {
  Scene scene = problem.scene;
  scene.integrator = std::string(run.integrator.name);
  const auto prepared = offered(subject.prepare, "prepare")(scene);
  run.x.floor = run.v.floor = problem.uncertainty;
  for (int level = 0, count = problem.coarsest; level < problem.levels; ++level, count *= 2) {
    const State end = end_of(subject, *prepared, scene, steps_of(run.pattern, problem.end, count));
    run.counts.push_back(count);
    for (Convergence* c : {&run.x, &run.v}) c->steps.push_back(problem.end / count);
    run.x.errors.push_back(largest_difference(end.x, problem.truth.x));
    run.v.errors.push_back(largest_difference(end.v, problem.truth.v));
    meter.add(count);
  }
  return run;
}

std::vector<Run> all_runs(const Subject& subject, const OrderProblem& problem, const Progress& progress) {
  offered(subject.step, "step");
  const std::vector<StepPattern> patterns = step_patterns();
  const double runs = double(integrators().size() * patterns.size());
  Meter meter{progress, runs * problem.coarsest * (std::pow(2, problem.levels) - 1)};
  std::vector<Run> all;
  for (const Integrator& integrator : integrators())
    for (const StepPattern& pattern : patterns)
      all.push_back(errors_of(subject, problem, {integrator, pattern, {}, {}, {}}, meter));
  return all;
}

std::vector<double> after_nan(std::vector<double> orders) {
  orders.insert(orders.begin(), nan);
  return orders;
}

/// Which of the two quantities of a run is meant.
struct Quantity {
  std::string name, words, unit;
  Convergence Run::*errors;
};

std::array<Quantity, 2> quantities() {
  return {{{"x", "positions", "m", &Run::x}, {"v", "velocities", "m/s", &Run::v}}};
}

NamedFinding finding_of(const OrderProblem& problem, const Run& run, const Quantity& quantity) {
  const Convergence& errors = run.*quantity.errors;
  const Estimate deviation = order_deviation(errors, run.integrator.order, pairs_judged);
  Finding finding{{deviation.value, bound, deviation.uncertainty, "1", why_bound},
                  {{"mean step", "s", errors.steps},
                   {"steps", "1", run.counts},
                   {"error in " + quantity.name, quantity.unit, errors.errors},
                   {"order of the pair", "1", after_nan(pair_orders(errors))}},
                  "measured is the largest |order - expected| over the last three pairs, where the table of "
                  "integrators states what is expected"};
  const std::string name(run.integrator.name);
  return {problem.study + "." + name + "." + std::string(run.pattern.name) + "." + quantity.name,
          "Scheme " + name + " is " + in_words(run.integrator.order) + " order in the " + quantity.words +
              " of " + problem.thing + " with " + std::string(run.pattern.words) + ".",
          std::move(finding)};
}

/// What decides on "second order only while the step is constant": B with both patterns of variable steps.
NamedFinding newmark_with_variable_steps(const OrderProblem& problem, const std::vector<Run>& runs) {
  constexpr double second = 2;  // in the paper's words, whatever the table says
  Worst deviation, uncertainty;
  std::vector<std::string> patterns, names;
  std::vector<double> orders;
  for (const Run& run : runs) {
    if (run.integrator.name != "B" || run.pattern.name == "constant") continue;
    for (const Quantity& quantity : quantities()) {
      const Convergence& errors = run.*quantity.errors;
      const Estimate one = order_deviation(errors, second, pairs_judged);
      deviation.see(one.value);
      uncertainty.see(one.uncertainty);
      patterns.emplace_back(run.pattern.name);
      names.push_back(quantity.name);
      orders.push_back(pair_orders(errors).back());
    }
  }
  Finding finding{
      {orders.empty() ? nan : deviation.value(), bound, uncertainty.value(), "1", why_bound},
      {{"steps", "1", patterns}, {"error in", "1", names}, {"order of the last pair", "1", orders}},
      "B is a one-step map with a local error of third order, so its order does not need a constant step"};
  return {problem.study + ".observed-in-B-with-variable-steps",
          "Scheme B is second order in x and v with alternating and with random steps, too.",
          std::move(finding)};
}

Figure figure_of(const OrderProblem& problem, const std::vector<Run>& runs, const Quantity& quantity) {
  Figure figure{"errors-in-" + quantity.name,
                "Error in the " + quantity.words + " of " + problem.thing,
                {"mean step", "s", Scale::log},
                {"largest error in " + quantity.name, quantity.unit, Scale::log},
                2,
                "Largest error of any coordinate at the end of the motion. The floor is the uncertainty of "
                "the reference solution.",
                {}};
  for (const Run& run : runs) {
    const Convergence& errors = run.*quantity.errors;
    figure.curves.push_back({run.label(), errors.steps, errors.errors, errors.floor, pair_orders(errors)});
  }
  return figure;
}

Table table_of(const std::vector<Run>& runs) {
  std::vector<std::string> schemes, patterns, names;
  std::vector<double> fitted, last, from, above;
  for (const Run& run : runs) {
    for (const Quantity& quantity : quantities()) {
      const Convergence& errors = run.*quantity.errors;
      const std::vector<double> orders = pair_orders(errors);
      const int first = asymptotic_from(orders, run.integrator.order, bound);
      schemes.emplace_back(run.integrator.name);
      patterns.emplace_back(run.pattern.name);
      names.push_back(quantity.name);
      fitted.push_back(fitted_order(errors));
      last.push_back(orders.back());
      from.push_back(first < int(orders.size()) ? errors.steps[size_t(first)] : nan);
      above.push_back(levels_above_floor(errors, 10));
    }
  }
  return {"orders",
          "Observed orders",
          {{"scheme", "1", schemes},
           {"steps", "1", patterns},
           {"error in", "1", names},
           {"order fitted to all levels", "1", fitted},
           {"order of the last pair", "1", last},
           {"asymptotic from mean step", "s", from},
           {"levels ten times above the floor", "1", above}}};
}

}  // namespace

std::vector<StepPattern> step_patterns() {
  constexpr int length = 8;
  StepPattern random{"random", "random steps", {}};
  std::mt19937_64 generator(20030726);
  double sum = 0;
  for (int i = 0; i < length; ++i) {
    const double uniform = double(generator() >> 11) * 0x1p-53;
    random.relative.push_back(std::pow(9, uniform));
    sum += random.relative.back();
  }
  for (double& step : random.relative) step *= length / sum;
  return {{"constant", "constant steps", {1}}, {"alternating", "steps alternating 9:1", {1.8, 0.2}}, random};
}

std::vector<double> steps_of(const StepPattern& pattern, double end, int count) {
  const int length = int(pattern.relative.size());
  if (!(count >= 1 && count % length == 0))
    throw InputError("step pattern '" + std::string(pattern.name) + "': " + std::to_string(count) +
                     " steps are no multiple of its " + std::to_string(length));
  std::vector<double> steps;
  for (int i = 0; i < count; ++i) steps.push_back(pattern.relative[size_t(i % length)] * end / count);
  return steps;
}

StudyResult time_order(const Subject& subject, const OrderProblem& problem, const Progress& progress) {
  const std::vector<Run> runs = all_runs(subject, problem, progress);
  StudyResult result;
  for (const Run& run : runs)
    for (const Quantity& quantity : quantities())
      result.findings.push_back(finding_of(problem, run, quantity));
  result.findings.push_back(newmark_with_variable_steps(problem, runs));
  for (const Quantity& quantity : quantities()) result.figures.push_back(figure_of(problem, runs, quantity));
  result.tables.push_back(table_of(runs));
  return result;
}

}  // namespace foldproof
