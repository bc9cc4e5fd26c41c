#include "scripts/program/any_case/precision_output.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

namespace foldproof {

namespace {

using nlohmann::json;

/// With three digits; "-" for NaN.
std::string three_digits(double value) {
  return std::isnan(value) ? "-" : fmt::format("{:.3g}", value);
}

void print_methods(const PrecisionAnswer& answer) {
  fmt::print("\n{:<22} {:>6} {:>12} {:>12}", "method", "order", "stable [s]", "not [s]");
  for (const double wanted : answer.plan.wanted)
    fmt::print("  {:>21}", fmt::format("price of {:.3g} %", 100 * wanted));
  fmt::print("  {}\n", "reading of its order");
  for (const MethodCurve& curve : answer.curves) {
    const double order = asymptotic_order(curve.bar);
    fmt::print("{:<22} {:>6} {:>12} {:>12}", curve.method,
               std::isnan(order) ? "-" : fmt::format("{:.2f}", order),
               three_digits(curve.stable_step), three_digits(curve.unstable_step));
    for (const PriceList& list : answer.lists) {
      const auto price = std::ranges::find(list.prices, curve.method, &MethodPrice::method);
      if (price == list.prices.end())
        fmt::print("  {:>21}", "for the truth only");
      else
        fmt::print("  {:>10} {:>10}",
                   is_priced(*price) ? fmt::format("{:.4g}", price->price.applications) : "-",
                   is_priced(*price) ? fmt::format("{:.3g} s", price->price.seconds) : "-");
    }
    fmt::print("  {}\n", in_words(curve.bar));
  }
}

/// How far winning steps were tried, and at what cost; steps that are stable in the run that is
/// asked about, but not until then.
void print_lasting(const PrecisionAnswer& answer, const Trials& trials) {
  long runs = 0;
  double seconds = 0;
  for (const auto& [method, levels] : trials.longer)
    for (const auto& [parts, run] : levels) ++runs, seconds += run.seconds;
  if (runs > 0)
    fmt::print(
        "steps that win were tried until {:.3g} s, as were half of them: {} runs, {:.3g} s\n",
        lasting_end(answer.plan), runs, seconds);
  for (const MethodCurve& curve : answer.curves)
    if (const double step = shortest_unstable_step(curve.longer); std::isfinite(step))
      fmt::print(
          "{}: steps of {:.3g} s or longer are not priced: unstable in a run until {:.3g} s\n",
          curve.method, step, lasting_end(answer.plan));
}

/// The command that runs the case with the cheapest method at its step: the one that was tried
/// until lasting_end, or else the automatic one; "" without a price.
std::string command_with(const MethodPrice& cheapest, const Options& options) {
  if (!is_priced(cheapest)) return "";
  std::string command = "foldproof simulate " + options.file;
  for (const std::string& change : options.overrides) command += fmt::format(" --set '{}'", change);
  const std::string step =
      std::isnan(cheapest.energy_gain) ? "automatic" : fmt::format("{:.12g}", cheapest.whole_step);
  return fmt::format("{} --set time.integrator={} --set time.step={}", command, cheapest.method,
                     step);
}

/// A reason that holds for several errors is printed once.
void print_missing_prices(const PrecisionAnswer& answer) {
  std::map<std::pair<std::string, std::string>, std::string> errors;  // of method and reason
  for (const PriceList& list : answer.lists)
    for (const MethodPrice& price : list.prices)
      if (!price.because.empty() && list.wanted >= least_error(answer.truth)) {
        std::string& all = errors[{price.method, price.because}];
        all += fmt::format("{}{:.3g} %", all.empty() ? "" : " and ", 100 * list.wanted);
      }
  for (const auto& [key, wanted] : errors)
    fmt::print("{} at {}: {}\n", key.first, wanted, key.second);
}

json to_json(const Opinion& opinion) {
  return {{"method", opinion.method},
          {"steps_a_frame", opinion.parts},
          {"extrapolated", opinion.is_extrapolated},
          {"error_bar", opinion.half_width}};
}

json to_json(const MethodPrice& price) {
  return {{"method", price.method},
          {"step", price.price.step},
          {"whole_step", price.whole_step},
          {"limited_by", name_of(price.price.limit)},
          {"applications", price.price.applications},
          {"seconds", price.price.seconds},
          {"over_cheapest", price.over_best},
          {"tied", price.is_tied},
          {"longer_run_energy_gain", price.energy_gain},
          {"lasts", std::isnan(price.energy_gain) ? json() : json(true)},  // if it was tried
          {"because", price.because}};
}

json to_json(const MethodCurve& curve) {
  json runs = json::array();
  for (const PrecisionRun& run : curve.runs)
    runs.push_back({{"steps_a_frame", run.parts},
                    {"steps", run.steps},
                    {"error", run.error},
                    {"applications", run.applications},
                    {"seconds", run.seconds},
                    {"unfinished_solves", run.work.unfinished_solves},
                    {"stopped", run.stopped}});
  json longer_runs = json::array();
  for (const LongerRun& run : curve.longer)
    longer_runs.push_back({{"step", run.step},
                           {"kinetic_energy", run.with_step.added},
                           {"kinetic_energy_with_half_the_step", run.with_half.added},
                           {"energy_gain", energy_gain(run)},
                           {"lasts", lasts(run)}});
  return {{"method", curve.method},
          {"order", asymptotic_order(curve.bar)},
          {"orders", curve.bar.orders},
          {"reading", name_of(curve.bar.reading)},
          {"because", curve.bar.reason},
          {"stable_step", curve.stable_step},
          {"unstable_step", curve.unstable_step},
          {"runs", runs},
          {"longer_runs", longer_runs}};
}

}  // namespace

void print(const PrecisionAnswer& answer, const Trials& trials, const Options& options) {
  for (const std::string& sentence : precision_sentences(answer)) fmt::print("{}\n", sentence);
  for (const PriceList& list : answer.lists)
    if (const std::string command = command_with(list.prices.front(), options); !command.empty())
      fmt::print("{:.3g} %: {}\n", 100 * list.wanted, command);
  fmt::print("{}\n", truth_in_words(answer));
  if (const std::string more = advice_in_words(answer); !more.empty()) fmt::print("{}\n", more);
  if (const std::string why = for_truth_in_words(answer); !why.empty()) fmt::print("{}\n", why);
  print_methods(answer);
  print_lasting(answer, trials);
  print_missing_prices(answer);
  fmt::print(
      "\norder: observed, where the range is asymptotic; price: applications of force operators, "
      "and seconds of the\nprocessor; stable, not: the longest step that is stable in this run, "
      "and the next longer one, which is not.\n");
}

void print(const SolverAnswer& solver, const PrecisionAnswer& reference, double case_end) {
  fmt::print("\n");
  for (const std::string& sentence : solver_sentences(solver.precision, reference))
    fmt::print("{}\n", sentence);
  fmt::print("\n{:>14} {:>12} {:>12} {:>14} {:>12}\n", "steps a frame", "step [s]", "error [%]",
             "processor [s]", "clock [s]");
  for (const PrecisionRun& run : solver.precision.curve.runs)
    fmt::print("{:>14} {:>12.3g} {:>12} {:>14} {:>12}  {}\n", run.parts,
               solver.precision.plan.frame / run.parts, three_digits(100 * run.error),
               three_digits(run.seconds), three_digits(run.clock), run.stopped);
  if (const double end = reference.plan.input_case.scene.schedule.end; end < case_end)
    fmt::print("its steps were tried until {:.3g} s; the case ends at {:.3g} s\n", end, case_end);
  for (const auto& [key, value] : solver.mapping) fmt::print("mapping of {}: {}\n", key, value);
}

nlohmann::json to_json(const PrecisionAnswer& answer, const Options& options) {
  json told = {{"case", answer.plan.input_case.scene.name},
               {"sentences", precision_sentences(answer)},
               {"advice", advice_in_words(answer)},
               {"truth",
                {{"first", to_json(answer.truth.first)},
                 {"second", to_json(answer.truth.second)},
                 {"motion", answer.truth.motion},
                 {"uncertainty", answer.truth.uncertainty},
                 {"good_down_to", least_error(answer.truth)},
                 {"methods_for_it_alone", answer.plan.for_truth}}},
               {"methods", json::array()},
               {"prices", json::array()}};
  for (const MethodCurve& curve : answer.curves) told["methods"].push_back(to_json(curve));
  for (const PriceList& list : answer.lists) {
    json prices = json::array();
    for (const MethodPrice& price : list.prices) prices.push_back(to_json(price));
    const std::string command = command_with(list.prices.front(), options);
    told["prices"].push_back({{"error", list.wanted}, {"use", command}, {"methods", prices}});
  }
  return told;
}

nlohmann::json to_json(const SolverAnswer& solver, const PrecisionAnswer& reference) {
  const SolverPrecision& precision = solver.precision;
  const ErrorBar& bar = precision.curve.bar;
  json told = {{"name", precision.plan.name},
               {"sentences", solver_sentences(precision, reference)},
               {"order", asymptotic_order(bar)},
               {"reading", name_of(bar.reading)},
               {"because", bar.reason},
               {"error_bar", bar.half_width},
               {"from_truth", precision.from_truth},
               {"explained_by_steps", precision.explained},
               {"runs", json::array()},
               {"prices", json::array()}};
  for (const PrecisionRun& run : precision.curve.runs)
    told["runs"].push_back({{"steps_a_frame", run.parts},
                            {"step", precision.plan.frame / run.parts},
                            {"error", run.error},
                            {"processor", run.seconds},
                            {"clock", run.clock},
                            {"stopped", run.stopped}});
  for (const SolverPrice& price : precision.prices)
    told["prices"].push_back({{"error", price.wanted},
                              {"step", price.price.step},
                              {"processor", price.price.seconds},
                              {"clock", price.price.clock},
                              {"is_whole_frame", price.price.limit == LimitedBy::not_tried},
                              {"unstable_step", price.unstable_step},
                              {"because", price.because}});
  for (const auto& [key, value] : solver.mapping) told["mapping"][key] = value;
  return told;
}

}  // namespace foldproof
