#include "convergence/any_case/settings_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "convergence/any_case/converge.h"

namespace foldproof {

std::vector<SettingsQuantity> settings_quantities(const SettingsCloth& cloth, double floor) {
  std::vector<SettingsQuantity> quantities = {
      {"positions", "m", floor}, {"sag", "m", floor}, {"height", "m", floor}};
  if (!cloth.edges.empty())
    quantities.push_back({"largest strain", "1", floor / cloth.lengths.minCoeff()});
  return quantities;
}

SettingsRun measured_run(const SettingsPair& at, const std::vector<PerParticle3>& frames,
                         const SettingsCloth& cloth) {
  SettingsRun run{at};
  if (frames.size() < 2) {
    run.stopped = "it has fewer than two frames";
    return run;
  }
  const PerParticle weight = (cloth.mass / cloth.mass.sum()).cwiseSqrt();
  Seen positions(3 * weight.size(), Eigen::Index(frames.size()) - 1);
  const Eigen::VectorXd start = (frames[0] * weight.asDiagonal()).reshaped();
  for (size_t f = 1; f < frames.size(); ++f)
    positions.col(Eigen::Index(f) - 1) = (frames[f] * weight.asDiagonal()).reshaped();
  run.motion = size_of(positions.colwise() - start);
  const Eigen::VectorXd first = cloth.up.transpose() * frames.front(),
                        last = cloth.up.transpose() * frames.back();
  double strain = 0;
  for (const PerParticle3& x : frames)
    for (size_t e = 0; e < cloth.edges.size(); ++e) {
      const double length = (x.col(cloth.edges[e].b) - x.col(cloth.edges[e].a)).norm();
      strain = std::max(strain, length / cloth.lengths[Eigen::Index(e)] - 1);
    }
  run.seen = {positions, Seen::Constant(1, 1, first.minCoeff() - last.minCoeff()),
              Seen::Constant(1, 1, last.maxCoeff() - last.minCoeff())};
  if (!cloth.edges.empty()) run.seen.push_back(Seen::Constant(1, 1, strain));
  if (!positions.allFinite()) run.stopped = "a position is not a number";
  return run;
}

SettingsAnswer settings_answer(SettingsMap map, const SettingsPair& in_use,
                               const std::vector<double>& wanted) {
  SettingsAnswer answer{std::move(map), "", "", in_use, wanted, {}};
  for (size_t q = 0; q < answer.map.quantities.size(); ++q) {
    QuantityAnswer of{own_limit(answer.map, q), {}, {}, ""};
    for (const double error : wanted) of.pairs.push_back(cheapest_pair(answer.map, q, error));
    of.in_use = pair_error(answer.map, q, in_use, of.limit);
    of.ends = end_of_refinement(answer.map, q, of.limit);
    const SettingsQuantity& quantity = answer.map.quantities[q];
    if (quantity.truth.size() > 0 && of.limit.value.size() > 0) {
      of.gap = size_of(of.limit.value - quantity.truth) / of.limit.scale;
      of.gap_bar = (of.limit.bar + quantity.truth_bar) / of.limit.scale;
    }
    answer.quantities.push_back(std::move(of));
  }
  return answer;
}

std::string pair_text(const SettingsMap& map, const SettingsPair& at) {
  return map.axes.size() > 1 ? fmt::format("{:.4g} x {:.4g}", at[0], at[1])
                             : fmt::format("{:.4g}", at[0]);
}

std::string_view name_of(Regime regime) {
  constexpr std::string_view names[] = {"discretisation", "unconverged solve", "rounding floor",
                                        "unknown"};
  return names[size_t(regime)];
}

namespace {

constexpr double hundred = 100;  // percent
constexpr double blown_up = 10;  // error, in motions, beyond which nothing else is worth saying

std::string regime_in_words(Regime regime) {
  switch (regime) {
    case Regime::discretisation:
      return "what you see is the discretisation";
    case Regime::unconverged:
      return "what you see is an unconverged solve";
    case Regime::rounding:
      return "what you see is the floor of rounding";
    default:
      return "what it is made of is not known: the second tunable has no three values there";
  }
}

std::string price_in_words(const SettingsAnswer& answer, const PricedPair& pair) {
  const std::string head = fmt::format("{:.2g} %", hundred * pair.wanted);
  if (!pair.because.empty()) return head + " has no pair: " + pair.because;
  const SettingsRun* own = answer.map.find(answer.in_use);
  const std::string times =
      own && own->cost > 0 ? fmt::format(", {:.2g} times the cost", pair.cost / own->cost) : "";
  return fmt::format("{} costs {}{}{}", head, pair_text(answer.map, pair.at), times,
                     pair.was_run ? "" : " (between two runs)");
}

/// How far the settings in use are from the limit.
std::string distance_in_words(const SettingsAnswer& answer, const std::string& name, double error,
                              const char* is) {
  const std::string at = pair_text(answer.map, answer.in_use);
  if (std::isnan(error)) return fmt::format("{}: no run of {} came to an end", name, at);
  if (error > blown_up)
    return fmt::format("at {} the run blows up: your {} {} off by {:.2g} times the motion", at,
                       name, is, error);
  return fmt::format("at {} your {} {} {:.2g} % from your own limit", at, name, is,
                     hundred * error);
}

std::string sentence_of(const SettingsAnswer& answer, size_t q) {
  const SettingsQuantity& quantity = answer.map.quantities[q];
  const QuantityAnswer& of = answer.quantities[q];
  if (!of.limit.none.empty()) return fmt::format("{}: no limit: {}", quantity.name, of.limit.none);
  if (!of.limit.unknown.empty())
    return fmt::format("{}: the limit is not known: {}", quantity.name, of.limit.unknown);
  std::string text = distance_in_words(answer, quantity.name, of.in_use.all, q == 0 ? "are" : "is");
  for (const PricedPair& pair : of.pairs) text += "; " + price_in_words(answer, pair);
  if (of.in_use.all <= blown_up) text += "; " + regime_in_words(of.in_use.regime);
  return text;
}

/// Where limits stand against the truth.
std::string gap_in_words(const std::string& name, const QuantityAnswer& of) {
  return fmt::format("{}: the limit is {:.2g} % from the truth, the bars are {:.2g} %: {}", name,
                     hundred * of.gap, hundred * of.gap_bar,
                     of.gap > std::max(of.gap_bar, 1e-3) ? "no pair reaches it" : "they agree");
}

}  // namespace

std::string cost_in_words(const SettingsMap& map) {
  if (!std::ranges::all_of(map.axes, &SettingsAxis::is_proportional)) return "";
  return fmt::format(", {:.2g} of the cost of a full grid", map.cost() / map.cost_of_grid());
}

std::vector<std::string> settings_sentences(const SettingsAnswer& answer) {
  std::vector<std::string> sentences;
  for (size_t q = 0; q < answer.quantities.size(); ++q) {
    sentences.push_back(sentence_of(answer, q));
    const QuantityAnswer& of = answer.quantities[q];
    if (!std::isnan(of.gap)) sentences.push_back(gap_in_words(answer.map.quantities[q].name, of));
    if (!of.ends.empty() && (q == 0 || answer.quantities[0].ends.empty()))
      sentences.push_back(of.ends);
  }
  if (!answer.step_check.empty()) sentences.push_back(answer.step_check);
  for (const ApparentMaterial& m : answer.material)
    sentences.push_back(fmt::format("{}: {:.3g} {} at {}, {:.3g} {} converged: {:.2g} of it",
                                    m.name, m.in_use, m.unit, pair_text(answer.map, answer.in_use),
                                    m.converged, m.unit, m.in_use / m.converged));
  return sentences;
}

namespace {

std::vector<double> values_on(const SettingsMap& map, size_t axis) {
  std::vector<double> values;
  for (const SettingsRun& run : map.runs)
    if (!std::ranges::count(values, run.at[axis])) values.push_back(run.at[axis]);
  std::ranges::sort(values);
  return values;
}

/// Where each row reaches the error.
Curve contour(const SettingsAnswer& answer, double wanted) {
  Curve curve{fmt::format("{:.2g} %", hundred * wanted)};
  for (const double other : values_on(answer.map, 1)) {
    SettingsMap row = answer.map;
    const PricedPair pair = pair_in_row(row, 0, other, answer.quantities[0].limit, wanted);
    if (std::isfinite(pair.cost)) curve.point(pair.at[0], other);
  }
  return curve;
}

/// Pairs whose product is that of a pair, within the map.
Curve equal_cost(const Map& drawn, const SettingsPair& at, double times) {
  Curve curve{fmt::format("{:.3g} times the cost", times)};
  for (const double other : drawn.y_values) {
    const double first = times * at[0] * at[1] / other;
    if (first >= drawn.x_values.front() && first <= drawn.x_values.back())
      curve.point(first, other);
  }
  return curve;
}

Map drawn_map(const SettingsAnswer& answer) {
  const SettingsMap& map = answer.map;
  Map drawn{"settings",
            "Error of positions over the settings",
            {map.axes[0].name, "", Scale::log},
            {map.axes[1].name, "", Scale::log},
            values_on(map, 0),
            values_on(map, 1),
            {},
            "distance from the own limit, over the motion",
            "1",
            Scale::log,
            "Distance from the solver's own limit. Contours of the wanted errors cross lines of "
            "equal cost; points mark the pair in use and the cheapest pairs. Without a value: "
            "pairs that were not run.",
            {}};
  for (const double other : drawn.y_values)
    for (const double first : drawn.x_values) {
      const SettingsRun* run = map.find({first, other});
      drawn.values.push_back(run ? error_of(*run, 0, answer.quantities[0].limit) : nan);
    }
  for (const double wanted : answer.wanted)
    if (Curve curve = contour(answer, wanted); curve.x.size() > 1) drawn.curves.push_back(curve);
  for (const double times : {1.0, 4.0, 16.0, 64.0})
    if (Curve curve = equal_cost(drawn, answer.in_use, times); curve.x.size() > 1)
      drawn.curves.push_back(curve);
  drawn.curves.push_back({"in use", {answer.in_use[0]}, {answer.in_use[1]}});
  for (const PricedPair& pair : answer.quantities[0].pairs)
    if (pair.because.empty())
      drawn.curves.push_back(
          {fmt::format("for {:.2g} %", hundred * pair.wanted), {pair.at[0]}, {pair.at[1]}});
  return drawn;
}

Table quantity_table(const SettingsAnswer& answer) {
  Table table(
      "quantity; in; own limit; error bar; error in use [%]; left by the first tunable [%]; left "
      "by the second [%]; from the truth [%]; order in the first [1]; made of; pairs");
  for (size_t q = 0; q < answer.quantities.size(); ++q) {
    const QuantityAnswer& of = answer.quantities[q];
    std::string pairs;
    for (const PricedPair& pair : of.pairs)
      pairs += (pairs.empty() ? "" : "; ") + price_in_words(answer, pair);
    table.row(answer.map.quantities[q].name, answer.map.quantities[q].unit,
              of.limit.value.size() == 1 ? fmt::format("{:.6g}", of.limit.value(0, 0))
                                         : std::string("\u2013"),
              of.limit.bar, hundred * of.in_use.all, hundred * of.in_use.of_first,
              hundred * of.in_use.of_second, hundred * of.in_use.from_truth, of.limit.order,
              std::string(name_of(of.in_use.regime)), pairs);
  }
  return {"quantities", "Each quantity, at the pair in use", table};
}

Table run_table(const SettingsAnswer& answer) {
  const SettingsMap& map = answer.map;
  Table table("pair; cost [1]; processor time [s]; error of positions [%]; stopped");
  for (const SettingsRun& run : map.runs)
    table.row(pair_text(map, run.at), run.cost, run.seconds,
              hundred * error_of(run, 0, answer.quantities[0].limit), run.stopped);
  return {"runs", "Every run", table};
}

}  // namespace

StudyRecord settings_study(const SettingsAnswer& answer) {
  StudyRecord study;
  study.name =
      fmt::format("converge.{}.{}.settings", as_name(answer.scene), as_name(answer.solver));
  study.source = "Roache 1994; Eca and Hoekstra 2014";
  for (const std::string& sentence : settings_sentences(answer))
    study.claim += (study.claim.empty() ? "" : ". ") + sentence;
  study.about = fmt::format("{} runs{}.", answer.map.runs.size(), cost_in_words(answer.map));
  for (const SettingsRun& run : answer.map.runs) study.seconds += run.seconds;
  study.tables = {quantity_table(answer), run_table(answer)};
  if (answer.map.axes.size() > 1 && answer.quantities[0].limit.value.size() > 0)
    study.maps = {drawn_map(answer)};
  return study;
}

}  // namespace foldproof
