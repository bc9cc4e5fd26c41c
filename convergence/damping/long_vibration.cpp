#include <algorithm>
#include <cmath>

#include "convergence/damping/artificial_damping.h"
#include "convergence/damping/sheet_modes.h"
#include "reference/dynamics/integrator.h"
#include "verification/specimens/random.h"
#include "verification/specimens/stepper.h"

namespace foldproof {

namespace {

/// Does a quantity that fluctuates drift? Its slope in time, and how far chance alone may tilt it.
struct Trend {
  double slope = 0;  // of the quantity, by least squares over the blocks [unit/unit of time]
  double error = 0;  // its standard error
  std::vector<double> times;  // middles of the blocks
  std::vector<double> means;  // of the quantity over each block
};

/// Fills times and means.
void average(const std::vector<double>& times, const std::vector<double>& values, int blocks,
             Trend& trend) {
  const double start = times.front(), span = (times.back() - start) / blocks;
  std::vector<double> sums(size_t(blocks), 0), counts = sums;
  for (size_t i = 0; i < times.size(); ++i) {
    const int block = std::min(blocks - 1, int((times[i] - start) / span));
    sums[size_t(block)] += values[i];
    ++counts[size_t(block)];
  }
  for (int k = 0; k < blocks; ++k) {
    if (counts[size_t(k)] == 0)
      throw InputError("trend_of: a block has no sample; take fewer blocks");
    trend.times.push_back(start + (k + 0.5) * span);
    trend.means.push_back(sums[size_t(k)] / counts[size_t(k)]);
  }
}

/// Averages the samples over `blocks` equal spans of time, so that what is correlated within a
/// block counts once, and fits a line. The standard error comes from the scatter about the line,
/// enlarged by sqrt((1 + r)/(1 - r)) where neighbouring blocks are still correlated, r > 0 being
/// the lag-one correlation of the scatter. Times must ascend, one for each value, and there must be
/// a sample in every block, else InputError.
Trend trend_of(const std::vector<double>& times, const std::vector<double>& values, int blocks) {
  if (times.size() != values.size() || blocks < 3 || times.empty() ||
      !(times.back() > times.front()))
    throw InputError(
        "trend_of: needs as many times as values, in ascending order, and at least three blocks");
  Trend trend;
  average(times, values, blocks, trend);

  const Eigen::Map<const PerParticle> t(trend.times.data(), blocks), y(trend.means.data(), blocks);
  const PerParticle centred = t.array() - t.mean();
  trend.slope = centred.dot(y) / centred.squaredNorm();
  const PerParticle scatter = (y.array() - y.mean()).matrix() - trend.slope * centred;
  const double lag_one =
      scatter.head(blocks - 1).dot(scatter.tail(blocks - 1)) / scatter.squaredNorm();
  const double enlarged = lag_one > 0 ? std::sqrt((1 + lag_one) / (1 - lag_one)) : 1;
  trend.error = enlarged * std::sqrt(scatter.squaredNorm() / (blocks - 2) / centred.squaredNorm());
  return trend;
}

/// At most some 500 of the values, evenly chosen.
std::vector<double> thin_out(const std::vector<double>& values) {
  const size_t stride = 1 + values.size() / 500;
  std::vector<double> kept;
  for (size_t i = 0; i < values.size(); i += stride) kept.push_back(values[i]);
  return kept;
}

constexpr double periods = 100;        // of the slowest mode
constexpr double part_of_limit = 0.5;  // equal step: of 2/omega_max
constexpr double blown_up = 10;        // times the energy at the start: the run is over
constexpr double least_shown = 1e-6;   // of the energy at the start
constexpr int blocks = 20;
constexpr double deflection = 0.02;  // m

/// A sheet that vibrates in all its modes, far beyond small deflections.
struct Vibration {
  Scene scene;
  double period;  // of the slowest mode at rest [s]
  double limit;   // 2/omega_max at rest [s]
};

/// Every mode gets the same energy on average, with random phases.
Vibration make_vibration(int cells) {
  Vibration vibration{sheet_at_rest(cells, {}), 0, 0};
  Scene& scene = vibration.scene;
  const std::vector<SheetMode> modes = modes_of(scene);
  vibration.period = 2 * pi / lowest_frequency(modes);
  vibration.limit = 2 / highest_frequency(modes);
  PerParticle3 x = PerParticle3::Zero(3, scene.x.cols()), v = x;
  Random random(61);
  for (const SheetMode& mode : modes) {
    const double phase = random.uniform(0, 2 * pi);
    x += std::cos(phase) / mode.frequency * mode.shape;
    v += std::sin(phase) * mode.shape;
  }
  const double scale = deflection / x.colwise().norm().maxCoeff();
  scene.x += scale * x;
  scene.v += scale * v;
  scene.solver.tolerance = 1e-9;
  return vibration;
}

/// The energy of one run, after every step.
struct Run {
  std::string method;
  double step;  // s
  Table history{{"time", "periods"}, {"energy", "of the start's"}};
  double cost = 0;        // evaluations a period [1]
  double unfinished = 0;  // solves that missed their tolerance [1]
  bool whole = true;      // it reached the end

  const std::vector<double>& times() const { return history.numbers("time"); }
  const std::vector<double>& energies() const { return history.numbers("energy"); }
};

/// Evaluations of all elastic forces, or of as much work: making ready their derivative, a
/// product with it.
double evaluations(const Work& work) {
  return double(work.elastic_evaluations + work.stiffness_preparations + work.stiffness_products);
}

/// Kinetic and elastic energy [J].
double energy_of(const Subject& subject, PreparedScene& prepared, const PerParticle& mass,
                 const State& s) {
  const double kinetic = s.v.colwise().squaredNorm().dot(mass.transpose()) / 2;
  return kinetic + require_offered(subject.potential_energy, "potential_energy")(prepared, s);
}

Run run_of(const Subject& subject, const Vibration& vibration, const std::string& method, double h,
           double length) {
  Scene scene = vibration.scene;
  scene.integrator = method;
  const PerParticle mass = lumped_masses(scene.mesh, scene.density);
  const auto prepared = require_offered(subject.prepare, "prepare")(scene);
  Stepper stepper(subject, scene, method);
  std::vector<State> past = {stepper.start()};
  const double start = energy_of(subject, *prepared, mass, past.front());
  Run run{.method = method, .step = h};
  run.history.row(0, 1);
  const double end = length * vibration.period;
  while (past.back().time < end - h / 2 && run.whole) {
    State next = stepper.step_after(past, h);
    const double energy = energy_of(subject, *prepared, mass, next) / start;
    run.whole = energy < blown_up;
    run.history.row(next.time / vibration.period, energy);
    if (past.size() > 1) past.erase(past.begin());
    past.push_back(std::move(next));
  }
  run.cost = evaluations(stepper.work()) / run.times().back();
  run.unfinished = double(stepper.work().unfinished_solves);
  return run;
}

constexpr double stride = 1.25;  // by which the search changes its step

/// The first periods, as many as tell the cost of a step.
Run first_periods(const Subject& subject, const Vibration& vibration, const std::string& method,
                  double h) {
  return run_of(subject, vibration, method, h, std::max(2.0, 20 * h / vibration.period));
}

/// The step [s] nearest to half the elastic limit, longer than it or shorter, between which and the
/// next `cost` evaluations a period are crossed. Where `patience` longer steps in turn are no
/// cheaper than the cheapest before them, or a solve does not finish, there is no such step, and
/// that one is taken.
struct Bracket {
  double step, next;  // s; equal if there is no crossing
};

Bracket bracket_of(const Subject& subject, const Vibration& vibration, const std::string& method,
                   double cost) {
  constexpr int patience = 4;
  const double start = part_of_limit * vibration.limit;
  double cheapest = first_periods(subject, vibration, method, start).cost, best = start, h = start;
  const bool dearer = cheapest > cost;
  for (int waited = 0; waited < patience;) {
    const double next = dearer ? h * stride : h / stride;
    const Run run = first_periods(subject, vibration, method, next);
    if (run.unfinished > 0) break;
    if ((run.cost > cost) != dearer) return {h, next};
    h = next;
    waited = !dearer || run.cost < cheapest ? 0 : waited + 1;
    if (waited == 0) best = h, cheapest = run.cost;
  }
  return {best, best};
}

double step_of_equal_cost(const Subject& subject, const Vibration& vibration,
                          const std::string& method, double cost) {
  auto [h, next] = bracket_of(subject, vibration, method, cost);
  const bool longer = next > h;
  for (int i = 0; h != next && i < 5; ++i) {
    const double middle = std::sqrt(h * next);
    const Run run = first_periods(subject, vibration, method, middle);
    ((run.cost > cost) == longer ? h : next) = middle;
  }
  return h;
}

// ---- what is said

NamedFinding has_no_trend(const Run& run) {
  constexpr double visible = 0.01;  // of the energy, in the whole run
  const Trend trend =
      run.whole ? trend_of(run.times(), run.energies(), blocks) : Trend{nan, nan, {}, {}};
  const double errors = std::abs(trend.slope) / trend.error;
  return {"artificial-damping.energy-has-no-trend." + run.method,
          "Over a hundred periods the energy of an undamped crumpling sheet has no trend under " +
              run.method +
              ": its slope is zero within three standard errors, and a trend of one percent would "
              "show.",
          {{3 * trend.error * periods <= visible ? errors : nan, 3, 0, "standard errors",
            "20 blocks of five periods, their spread corrected for the correlation of neighbours: "
            "without a trend three standard errors are exceeded once in a hundred runs"},
           {{"block", "periods", trend.times}, {"mean energy", "of the start's", trend.means}},
           "The slope is " + std::to_string(trend.slope * periods) + " +- " +
               std::to_string(trend.error * periods) +
               " of the energy in a hundred periods; three times the error is the smallest trend "
               "that this notices."}};
}

/// At most some 500 steps of it.
Table thinned_history(const Run& run) {
  Table table;
  for (const Column& column : run.history.columns())
    table.add({column.name, column.unit, thin_out(run.history.numbers(column.name))});
  return table;
}

NamedFinding stays_bounded(const Run& run) {
  // a mode keeps p^2 + (1 - (omega h/2)^2) (omega q)^2, which lies between 1 - (omega h/2)^2 and
  // 1 of its energy
  const double kept = 1 - part_of_limit * part_of_limit;
  Worst worst;
  for (const double energy : run.energies()) worst.observe(std::abs(std::log(energy)));
  return {"artificial-damping.energy-stays-bounded." + run.method,
          "Over a hundred periods the energy of an undamped crumpling sheet stays within the range "
          "that the fastest mode's oscillation allows under " +
              run.method + ".",
          {{run.whole ? worst.value() : nan, -std::log(kept), 0, "|ln(energy/start)|",
            "a linear mode's energy lies between 1 and 1 - (omega h/2)^2 of a number that the "
            "scheme conserves; omega h/2 is at most a half"},
           thinned_history(run)}};
}

NamedFinding dies_out(const Run& run) {
  return {"artificial-damping.energy-dies-out.backward-euler",
          "Backward Euler takes away more than half the energy of an undamped sheet within a "
          "hundred periods at half the elastic limit.",
          {{run.energies().back(), 0.5, 0, "of the start's energy",
            "half of the energy is what we call significant"},
           thinned_history(run)}};
}

/// Means over equal spans of a curve of many steps, so that it can be read; a short one as it is.
Curve readable_curve(const Run& run) {
  constexpr int spans = 50;
  Curve curve = curve_of(run.method, run.history, "time", "energy");
  if (run.history.rows() > spans + 1) {
    const Trend trend = trend_of(run.times(), run.energies(), spans);
    curve.x = trend.times;
    curve.y = trend.means;
  }
  for (double& energy : curve.y)
    if (!(energy > least_shown)) energy = nan;
  return curve;
}

Figure energy_figure(const std::string& name, const std::string& title, const std::string& caption,
                     const std::vector<Run>& runs) {
  Figure figure{name,
                title,
                {"time", "periods of the slowest mode"},
                {"energy over that of the start", "1", Scale::log},
                caption};
  for (const Run& run : runs) figure.curves.push_back(readable_curve(run));
  return figure;
}

Table energy_table(const Vibration& vibration, const std::vector<Run>& same_step,
                   const std::vector<Run>& same_cost) {
  Table table(
      "method [1]; equal [1]; step over 2/omega_max [1]; evaluations [a period]; lasted [periods]; "
      "energy at the end [of the start's]; unfinished solves [1]");
  for (const auto& [runs, words] : {std::pair{&same_step, "step"}, {&same_cost, "cost"}})
    for (const Run& run : *runs)
      table.row(run.method, words, run.step / vibration.limit, run.cost, run.times().back(),
                run.energies().back(), run.unfinished);
  return {"energy",
          "Energy of an undamped sheet after a hundred periods, at equal step and at a step chosen "
          "for equal cost",
          table};
}

}  // namespace

void add_long_vibrations(const Subject& subject, Tier tier, StudyResult& result) {
  const Vibration vibration = make_vibration(tier == Tier::quick ? 2 : 4);
  const double h = part_of_limit * vibration.limit;
  std::vector<Run> same_step, same_cost;
  for (const Integrator& method : integrators()) {
    const std::string name(method.name);
    same_step.push_back(run_of(subject, vibration, name, h, periods));
    const Run& run = same_step.back();
    if (method.family == Family::mixed || name == "implicit-midpoint") {
      result.add({has_no_trend(run), stays_bounded(run)});
    }
    if (name == "backward-euler") result.findings.push_back(dies_out(run));
  }
  for (const Integrator& method : integrators()) {
    const std::string name(method.name);
    const double step = step_of_equal_cost(subject, vibration, name, same_step.front().cost);
    same_cost.push_back(run_of(subject, vibration, name, step, periods));
  }
  result.figures.push_back(
      energy_figure("energy-at-equal-step", "Energy of an undamped sheet, equal step",
                    "Means over two periods; all steps are half the elastic limit. Curves that end "
                    "have left the picture: upwards when the energy passed ten times the start's.",
                    same_step));
  result.figures.push_back(energy_figure(
      "energy-at-equal-cost", "Energy of an undamped sheet, equal cost",
      "As above, with each method's step chosen such that it makes as many evaluations of the "
      "forces, or products with their derivative, as scheme A does at half the elastic limit: the "
      "step nearest to A's, judged by the first periods. The table has the cost of the whole run; "
      "a method that no step makes as cheap as A runs at its cheapest step.",
      same_cost));
  result.tables.push_back(energy_table(vibration, same_step, same_cost));
}

}  // namespace foldproof
