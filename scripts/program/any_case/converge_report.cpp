#include "scripts/program/any_case/converge_report.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "convergence/any_case/converge.h"

namespace foldproof {

namespace {

using nlohmann::json;

std::string number(double value) { return std::isnan(value) ? "-" : fmt::format("{:.6g}", value); }

std::string orders_in_words(const ErrorBar& bar) {
  std::string words;
  for (const double order : bar.orders)
    words += (words.empty() ? "" : " ") + (std::isnan(order) ? "-" : fmt::format("{:.2f}", order));
  return words;
}

bool is_in_space(const LadderAnswer& answer) { return answer.in == "space"; }

void print_head(const LadderAnswer& answer) {
  if (!is_in_space(answer)) {
    fmt::print("{}, method {}, in {}: {} levels; mean step {:.3g} s down to {:.3g} s\n",
               answer.scene, answer.method, answer.in, answer.sizes.size(), answer.sizes.front(),
               answer.sizes.back());
    return;
  }
  fmt::print(
      "{}, method {}, in space: {} levels; mean edge {:.3g} m down to {:.3g} m, {} to {} "
      "particles\n"
      "refined by {}; formal order 2; all levels take the steps of the finest, mean {:.3g} s\n",
      answer.scene, answer.method, answer.sizes.size(), answer.sizes.front(), answer.sizes.back(),
      answer.particles.front(), answer.particles.back(), answer.refined_by, answer.mean_step);
}

void print_notes(const LadderAnswer& answer) {
  const bool in_space = is_in_space(answer);
  fmt::print(
      "\nlimit: Richardson's value for {} of no length; +-: error bar of the finest level (grid "
      "convergence index);\n"
      "as it is: error of the case with its own {}, bar included.\n",
      in_space ? "edges" : "steps", in_space ? "mesh" : "step");
  for (const std::string& warning : answer.warnings) fmt::print("warning: {}\n", warning);
  for (size_t k = 0; k < answer.stopped.size(); ++k)
    if (!answer.stopped[k].empty()) fmt::print("level {} stopped: {}\n", k, answer.stopped[k]);
  fmt::print("{}\n", order_in_words(answer));
}

json to_json(const QuantityOverLevels& q) {
  return {{"name", q.name},
          {"unit", q.unit},
          {"values", q.values},
          {"differences", q.differences},
          {"orders", q.bar.orders},
          {"reading", name_of(q.bar.reading)},
          {"because", q.bar.reason},
          {"order", q.bar.order},
          {"limit", q.bar.limit},
          {"safety_factor", q.bar.safety},
          {"error_bar", q.bar.half_width},
          {"error_as_it_is", q.first_error},
          {"error_of_steps", q.step_error}};
}

json to_json(const Twin& twin) {
  return {{"disturbance", twin.disturbance},
          {"distances", twin.distances},
          {"horizon", twin.horizon},
          {"stopped", twin.stopped}};
}

json to_json(const StatisticOverRuns& s) {
  return {{"name", s.name},   {"unit", s.unit},     {"mean", s.mean},    {"spread", s.spread},
          {"reach", s.reach}, {"levels", s.levels}, {"agrees", s.agrees}};
}

/// "all" or the numbers of the levels that do not agree.
std::string levels_outside(const StatisticOverRuns& s) {
  std::string outside;
  for (size_t k = 0; k < s.agrees.size(); ++k)
    if (!s.agrees[k]) outside += (outside.empty() ? "" : ", ") + std::to_string(k + 1);
  return outside.empty() ? "-" : outside;
}

}  // namespace

void print(const MapAnswer& answer) {
  fmt::print("\nstep and mesh together:\n");
  for (const std::string& line : map_in_words(answer.map, answer.pairs)) fmt::print("{}\n", line);
}

json to_json(const MapAnswer& answer) {
  const ErrorMap& map = answer.map;
  json told = {
      {"because", map.reason},
      {"step", map.step},
      {"edge", map.edge},
      {"motion", map.motion},
      {"step_error", {{"as_it_is", map.step_error.as_it_is}, {"order", map.step_error.exponent}}},
      {"mesh_error", {{"as_it_is", map.mesh_error.as_it_is}, {"order", map.mesh_error.exponent}}},
      {"work", map.work},
      {"work_by_step", map.work_by_step},
      {"work_by_edge", map.work_by_edge},
      {"seconds_by_work", map.seconds_by_work},
      {"particles", map.particles},
      {"particles_by_edge", map.particles_by_edge},
      {"longest_step_by_edge", map.longest_by_edge},
      {"step_error_ratio", map.step_error_ratio},
      {"warnings", map.warnings},
      {"cheapest", json::array()}};
  for (const CheapestPair& pair : answer.pairs)
    told["cheapest"].push_back({{"error", pair.wanted},
                                {"step", pair.step},
                                {"edge", pair.edge},
                                {"particles", pair.particles},
                                {"seconds", pair.seconds},
                                {"halving_costs", pair.halving_costs},
                                {"limited_by_rule", pair.is_limited_by_rule}});
  return told;
}

void print(const LadderAnswer& answer) {
  const bool in_space = is_in_space(answer);
  print_head(answer);
  fmt::print("\n{:<24} {:<10} {:<16} {:>12} {:>10} {:>10}{}  {}\n", "quantity", "unit",
             "order by pair", "limit", "+-", "as it is", in_space ? "      steps" : "", "reading");
  for (const QuantityOverLevels& q : answer.quantities)
    fmt::print("{:<24} {:<10} {:<16} {:>12} {:>10.2g} {:>10.2g}{}  {}\n", q.name, q.unit,
               orders_in_words(q.bar), number(q.bar.limit), q.bar.half_width, q.first_error,
               in_space ? fmt::format(" {:>10.2g}", q.step_error) : "", in_words(q.bar));
  print_notes(answer);
}

json to_json(const LadderAnswer& answer) {
  json answer_json = {{"case", answer.scene},
                      {"method", answer.method},
                      {"in", answer.in},
                      {is_in_space(answer) ? "mean_edge" : "mean_step", answer.sizes},
                      {"mean_step_of_finest", answer.mean_step},
                      {"particles", answer.particles},
                      {"work", answer.work},
                      {"seconds", answer.seconds},
                      {"stopped", answer.stopped},
                      {"warnings", answer.warnings},
                      {"halving", how_to_halve(answer)},
                      {"has_order", name_of(order_verdict(answer))},
                      {"in_words", order_in_words(answer)},
                      {"quantities", json::array()}};
  if (!answer.clock.empty()) answer_json["clock"] = answer.clock;
  if (is_in_space(answer)) {
    answer_json["refined_by"] = answer.refined_by;
    answer_json["formal_order"] = 2;
    answer_json["level_overrides"] = answer.overrides;
  }
  for (const QuantityOverLevels& q : answer.quantities)
    answer_json["quantities"].push_back(to_json(q));
  return answer_json;
}

void print(const PredictabilityAnswer& answer) {
  fmt::print("{}\n", in_words(answer.of));
  if (answer.statistics.empty()) return;
  fmt::print(
      "\nmeans over the time beyond it, of {} runs with disturbed starts:\n{:<28} {:<4} {:>12} "
      "{:>10} {:>10}  {}\n",
      answer.ensemble, "statistic", "unit", "mean", "spread", "+-", "levels outside");
  for (const StatisticOverRuns& s : answer.statistics)
    fmt::print("{:<28} {:<4} {:>12.5g} {:>10.2g} {:>10.2g}  {}\n", s.name, s.unit, s.mean, s.spread,
               s.reach, levels_outside(s));
  fmt::print("+-: 95 of 100 further runs lie within it of the mean (Student's t)\n");
}

json to_json(const PredictabilityAnswer& answer) {
  const Predictability& p = answer.of;
  json told = {{"in_words", in_words(p)},
               {"horizon", p.horizon},
               {"fraction", p.fraction},
               {"motion", p.motion},
               {"end", p.end},
               {"times", p.times},
               {"growth_rate", p.growth.rate},
               {"growth_rate_uncertainty", p.growth.uncertainty},
               {"fitted_from", p.growth.from},
               {"fitted_to", p.growth.to},
               {"because", p.reason},
               {"twins", {to_json(p.rounding), to_json(p.error)}},
               {"ensemble", answer.ensemble},
               {"statistics", json::array()}};
  for (const StatisticOverRuns& s : answer.statistics) told["statistics"].push_back(to_json(s));
  return told;
}

}  // namespace foldproof
