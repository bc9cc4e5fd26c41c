// The price of a wanted error with another solver, in words, figures and tables.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "convergence/any_case/ladder_study.h"
#include "convergence/any_case/solver_precision.h"

namespace foldproof {

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
  Table table{{"error wanted", "%"},
              {"step", "s"},
              {"processor time", "s"},
              {"by the clock, through the pipe", "s"},
              {"cheapest method of the reference", "1"},
              {"its step", "s"},
              {"its processor time", "s"},
              {"note", "1"}};
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
  Table table{{"steps a frame", "1"},
              {"step", "s"},
              {"error", "%"},
              {"processor time", "s"},
              {"by the clock, through the pipe", "s"},
              {"stopped", "1"}};
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
