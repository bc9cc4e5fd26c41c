#include "convergence/any_case/solver_precision.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "convergence/any_case/converge.h"

namespace foldproof {

namespace {

constexpr int most_doublings = 12;  // of steps a frame, beyond the first that was tried

double distance(const SolverPlan& plan, const LevelRun& a, const LevelRun& b) {
  return frame_distance(a.x, b.x, plan.mass);
}

MethodCurve curve_of(const SolverPlan& plan, const TrialLevels& runs) {
  MethodCurve curve{{plan.name, {}}, ladder_bar(runs, plan.mass, plan.formal_order, plan.floor)};
  const auto whole = fine_end(runs);
  const double frames = plan.end / plan.frame;
  for (const auto& [parts, run] : runs) {
    double error = nan;
    if (is_whole(run) && !whole.empty() && curve.bar.reading != Reading::inconclusive)
      error = (distance(plan, run, *whole.back().second) + curve.bar.half_width) / plan.motion;
    curve.runs.push_back({int(std::lround(parts * frames)),
                          error,
                          parts * frames,
                          run.seconds,
                          1,
                          {},
                          parts,
                          run.stopped,
                          run.clock});
  }
  return curve;
}

/// Where rounding hides what a further halving changes.
bool is_rounding(const SolverPlan& plan, const TrialLevels& runs) {
  const auto whole = fine_end(runs);
  if (whole.size() < 2) return false;
  const auto last = whole.end() - 1, before = whole.end() - 2;
  return distance(plan, *before->second, *last->second) <= floors_for_order * plan.floor;
}

bool is_exact_enough(const SolverPlan& plan, const TrialLevels& runs) {
  if (fine_end(runs).size() < 3) return false;
  if (is_rounding(plan, runs)) return true;
  const ErrorBar bar = ladder_bar(runs, plan.mass, plan.formal_order, plan.floor);
  return bar.reading != Reading::inconclusive &&
         bar.half_width / plan.motion <= truth_part * plan.wanted.back();
}

/// Whether to try a step twice as long: the longest so far reaches the largest wanted error, or an
/// error bar still lacks one of its three runs.
bool needs_longer_step(const SolverPlan& plan, const TrialLevels& runs) {
  const auto& [parts, run] = *runs.begin();
  if (!is_whole(run) || parts % 2 != 0) return false;
  const auto whole = fine_end(runs);
  return whole.size() < 3 ||
         distance(plan, run, *whole.back().second) / plan.motion <= plan.wanted.front();
}

bool is_unstable(const PrecisionRun& run) { return !(run.error <= diverged_error); }

/// Steps a frame between a step that reaches a wanted error and the next longer one, which is
/// unstable; 0: all such steps are close.
int between_unstable(const SolverPlan& plan, const TrialLevels& runs) {
  const MethodCurve curve = curve_of(plan, runs);
  for (const double wanted : plan.wanted) {
    const size_t first = first_exact(curve, wanted);
    if (first == 0 || first == curve.runs.size() || !is_unstable(curve.runs[first - 1])) continue;
    const int few = curve.runs[first - 1].parts, many = curve.runs[first].parts;
    if (many > narrow * few && many - few > 1) return (few + many) / 2;
  }
  return 0;
}

SolverPrice price_of(const SolverPlan& plan, const MethodCurve& curve, double wanted) {
  SolverPrice price{wanted, price_at(curve, plan.end, wanted)};
  if (!(plan.motion > 0))
    price.because = "how far the reference moves is not known";
  else if (curve.bar.reading == Reading::inconclusive)
    price.because = "its halved steps show no order: " + curve.bar.reason;
  else if (price.price.limit == LimitedBy::not_reached)
    price.because = "no step that was tried reaches it; a shorter one would take too long";
  else if (price.price.limit == LimitedBy::stability)
    price.unstable_step = plan.frame / curve.runs[first_exact(curve, wanted) - 1].parts;
  return price;
}

/// Of the frames at these times; empty where one is missing.
std::vector<PerParticle3> frames_at(const LevelRun& run, const std::vector<double>& times) {
  std::vector<PerParticle3> x;
  for (const double time : times) {
    const auto found = std::ranges::find_if(
        run.times, [&](double at) { return std::abs(at - time) <= 1e-9 * run.times.back(); });
    if (found == run.times.end()) return {};
    x.push_back(run.x[size_t(found - run.times.begin())]);
  }
  return x;
}

}  // namespace

int next_parts(const SolverPlan& plan, const TrialLevels& runs) {
  if (runs.empty()) return plan.first;
  const int parts = finest(runs).first;
  const LevelRun& run = runs.at(parts);
  const bool may_halve = parts < plan.first << most_doublings &&
                         (!is_whole(run) || 2 * run.clock <= plan.most_seconds);
  if (may_halve && !is_exact_enough(plan, runs)) return 2 * parts;
  if (needs_longer_step(plan, runs)) return runs.begin()->first / 2;
  return between_unstable(plan, runs);
}

bool SolverPrecision::is_answered() const {
  return std::ranges::all_of(prices,
                             [](const SolverPrice& p) { return std::isfinite(p.price.step); });
}

SolverPrecision solver_precision(const SolverPlan& plan, const TrialLevels& runs,
                                 const CaseTruth& truth, const std::vector<double>& times) {
  SolverPrecision answer{plan, curve_of(plan, runs), {}};
  for (const double wanted : plan.wanted)
    answer.prices.push_back(price_of(plan, answer.curve, wanted));
  const auto whole = fine_end(runs);
  if (whole.empty() || truth.first.x.empty()) return answer;
  const std::vector<PerParticle3> x = frames_at(*whole.back().second, times);
  if (x.size() != truth.first.x.size()) return answer;
  answer.from_truth = largest_difference(x, truth.first.x, plan.mass);
  const ErrorBar& bar = answer.curve.bar;
  if (bar.reading != Reading::inconclusive)
    answer.explained = bar.half_width + truth.uncertainty * truth.motion;
  return answer;
}

// The answer in words, figures and tables.

namespace {

constexpr double percent = 100, milli = 1e-3;

const PriceList* prices_at(const PrecisionAnswer& reference, double wanted) {
  const auto list = std::ranges::find(reference.lists, wanted, &PriceList::wanted);
  return list == reference.lists.end() || std::isnan(list->prices.front().price.applications)
             ? nullptr
             : &*list;
}

/// Why no longer step has a price although its error is not known to be too large; "" if the
/// error is the limit.
std::string limit_in_words(const SolverPrice& price) {
  if (price.price.limit == LimitedBy::not_tried)
    return "one step a frame; no longer step can be tried";
  if (std::isnan(price.unstable_step)) return "";
  return fmt::format("limited by stability: {:.3g} ms is unstable", price.unstable_step / milli);
}

std::string price_in_words(const SolverPrice& price) {
  if (!price.because.empty()) return price.because;
  const std::string limit = limit_in_words(price);
  const auto& [limited_by, step, steps, processor, unfinished, clock] = price.price;
  return fmt::format("h {} {:.3g} ms{}, {:.2g} s of the processor, {:.2g} s by the clock",
                     limited_by == LimitedBy::not_tried ? ">=" : "=", step / milli,
                     limit.empty() ? "" : " (" + limit + ")", processor, clock);
}

std::string beside(const PrecisionAnswer& reference, double wanted) {
  const PriceList* list = prices_at(reference, wanted);
  if (!list) return "the reference has no price for it";
  const MethodPrice& best = list->prices.front();
  return fmt::format("the reference with {} h = {:.3g} ms, {:.2g} s of the processor", best.method,
                     best.whole_step / milli, best.price.seconds);
}

std::string gap_in_words(const SolverPrecision& solver) {
  const std::string head = fmt::format("the limit of {} is ", solver.plan.name);
  if (std::isnan(solver.from_truth) || std::isnan(solver.explained))
    return head + "not compared with the reference: one of them is not known";
  return head +
         fmt::format(
             "{:.2g} % of the motion from the reference's truth, the error bars are {:.2g} %: {}",
             percent * solver.from_truth / solver.plan.motion,
             percent * solver.explained / solver.plan.motion,
             solver.from_truth > solver.explained
                 ? "the time step does not explain the difference, so the models differ"
                 : "steps may explain it");
}

/// The reference's methods that win at some error.
std::vector<std::string> winning_methods(const PrecisionAnswer& reference) {
  std::vector<std::string> methods;
  for (const PriceList& list : reference.lists)
    for (const MethodPrice* price : winners(list))
      if (!std::ranges::count(methods, price->method)) methods.push_back(price->method);
  return methods;
}

/// Of the runs that have an error.
Curve measured_curve(PrecisionCurve curve, const CostAxis& cost, double end, double floor) {
  std::erase_if(curve.runs, [](const PrecisionRun& run) { return !std::isfinite(run.error); });
  Curve points = error_curve(curve, cost, end, floor);
  points.marks.clear();
  return points;
}

Figure figure_of(const SolverPrecision& solver, const PrecisionAnswer& reference,
                 const CostAxis& cost) {
  Figure figure{cost.name,
                fmt::format("Error against {}: {}", cost.name, solver.plan.name),
                cost.axis,
                {"position error over the motion", "%", Scale::log},
                nan,
                "Each program's error is the distance from its own limit. Of the reference the "
                "methods are shown that are cheapest at a wanted error.",
                {}};
  const double end = solver.plan.end;
  Curve curve = measured_curve(solver.curve, cost, end, nan);
  if (!curve.x.empty()) figure.curves.push_back(std::move(curve));
  for (const std::string& method : winning_methods(reference)) {
    const auto found = std::ranges::find(reference.curves, method, &MethodCurve::method);
    figure.curves.push_back(measured_curve(*found, cost, end, reference.truth.uncertainty));
    figure.curves.back().label = "reference, " + method;
  }
  return figure;
}

Table price_table(const SolverPrecision& solver, const PrecisionAnswer& reference) {
  Table table(
      "error wanted [%]; step [s]; processor time [s]; by the clock, through the pipe [s]; "
      "cheapest method of the reference [1]; its step [s]; its processor time [s]; note [1]");
  for (const SolverPrice& price : solver.prices) {
    const PriceList* list = prices_at(reference, price.wanted);
    const MethodPrice none{"none", {}};
    const MethodPrice& best = list ? list->prices.front() : none;
    table.row(percent * price.wanted, price.price.step, price.price.seconds, price.price.clock,
              best.method, best.price.step, best.price.seconds,
              price.because.empty() ? limit_in_words(price) : price.because);
  }
  return {"prices", "What a position error costs", table};
}

Table step_table(const SolverPrecision& solver) {
  Table table(
      "steps a frame [1]; step [s]; error [%]; processor time [s]; by the clock, through the pipe "
      "[s]; stopped [1]");
  for (const PrecisionRun& run : solver.curve.runs)
    table.row(run.parts, solver.plan.frame / run.parts, percent * run.error, run.seconds, run.clock,
              run.stopped);
  return {"runs", "Every run; no error where it came to no end, or without an order", table};
}

}  // namespace

std::vector<std::string> solver_sentences(const SolverPrecision& solver,
                                          const PrecisionAnswer& reference) {
  std::vector<std::string> sentences;
  for (const SolverPrice& price : solver.prices)
    sentences.push_back(fmt::format("{} at {:.3g} %: {}; {}", solver.plan.name,
                                    percent * price.wanted, price_in_words(price),
                                    beside(reference, price.wanted)));
  sentences.push_back(gap_in_words(solver));
  return sentences;
}

StudyRecord solver_precision_record(const SolverPrecision& solver,
                                    const PrecisionAnswer& reference) {
  StudyRecord record;
  record.name = fmt::format("precision.{}.{}", reference.plan.input_case.scene.name,
                            as_name(solver.plan.name));
  record.claim = fmt::format("{}.", fmt::join(solver_sentences(solver, reference), ". "));
  record.about =
      "Which step of another solver reaches a wanted error, and what does it cost? Its steps are "
      "equal from frame to frame, and halved from run to run. Its error is the distance from its "
      "finest run, and that run's error bar; both over the reference's motion. Prices are "
      "interpolated in logarithms between the two steps that bracket the error.";
  for (const PrecisionRun& run : solver.curve.runs) record.seconds += run.clock;
  for (const CostAxis& cost : cost_axes())
    if (cost.name != "work") record.figures.push_back(figure_of(solver, reference, cost));
  record.tables = {price_table(solver, reference), step_table(solver)};
  return record;
}

}  // namespace foldproof
