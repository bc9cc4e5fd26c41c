// The map of error over step and mesh as evidence: a heat map, lines of equal cost, tables.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "convergence/any_case/error_map.h"

namespace foldproof {

namespace {

constexpr int columns = 25, rows = 21, steps_an_octave = 3;

/// Ascending, `count` values up to `last`.
std::vector<double> ascending(double last, int count) {
  std::vector<double> values;
  for (int k = 0; k < count; ++k)
    values.push_back(last * std::exp2(double(k - count + 1) / steps_an_octave));
  return values;
}

/// Where the cost is `seconds`: the step for each edge, within the map.
Curve equal_cost(const ErrorMap& map, const Map& on, double seconds) {
  Curve curve{fmt::format("{:.2g} s", seconds), {}, {}, nan, {}, nan, {}};
  for (const double dx : on.y_values) {
    const double h = map.step * std::pow(map.seconds(map.step, dx) / seconds, 1 / map.work_by_step);
    if (h >= on.x_values.front() && h <= on.x_values.back()) curve.point(h, dx);
  }
  return curve;
}

/// The cheapest pairs for errors that are halved.
Curve cheapest_path(const ErrorMap& map, const Map& on) {
  Curve curve{"cheapest", {}, {}, nan, {}, nan, {}};
  const double largest = map.error(map.step, map.edge);
  for (int k = 0; k < 2 * rows; ++k) {
    const CheapestPair pair = cheapest_pair(map, largest * std::exp2(-k / 2.0));
    if (pair.step >= on.x_values.front() && pair.step <= on.x_values.back() &&
        pair.edge >= on.y_values.front() && pair.edge <= on.y_values.back())
      curve.point(pair.step, pair.edge);
  }
  return curve;
}

Map drawn_map(const ErrorMap& map) {
  Map drawn{"error",
            "Error of positions over step and mesh",
            {"mean step", "s", Scale::log},
            {"edge", "m", Scale::log},
            ascending(map.step, columns),
            ascending(map.edge, rows),
            {},
            "error over the motion",
            "1",
            Scale::log,
            "The sum of the step's error and the mesh's, each a power law through its ladder. "
            "Lines: equal cost, in seconds of one processor; the cheapest pair for each error. "
            "Without a value: steps longer than the case's own rule takes.",
            {}};
  for (const double dx : drawn.y_values)
    for (const double h : drawn.x_values)
      drawn.values.push_back(h <= map.longest_step(dx) * (1 + 1e-9) ? map.error(h, dx) : nan);
  const double own = map.seconds(map.step, map.edge);
  for (const double times : {1.0, 10.0, 100.0, 1000.0})
    if (Curve curve = equal_cost(map, drawn, times * own); curve.x.size() > 1)
      drawn.curves.push_back(std::move(curve));
  if (Curve path = cheapest_path(map, drawn); path.x.size() > 1)
    drawn.curves.push_back(std::move(path));
  return drawn;
}

Table pairs_table(const ErrorMap& map, const std::vector<CheapestPair>& pairs) {
  Table table{{"wanted error", "1"},  {"step", "s"},           {"edge", "m"},
              {"particles", "1"},     {"processor time", "s"}, {"over the case as it is", "1"},
              {"for half of it", "1"}};
  for (const CheapestPair& pair : pairs)
    table.row(pair.wanted, pair.step, pair.edge, pair.particles, pair.seconds,
              pair.seconds / map.seconds(map.step, map.edge), pair.halving_costs);
  return {"pairs", "The cheapest pair for each wanted error, forecast", table};
}

}  // namespace

StudyRecord map_study(const ErrorMap& map, const std::vector<CheapestPair>& pairs) {
  StudyRecord study;
  study.name = fmt::format("converge.{}.{}.map", map.scene, map.method);
  study.source = "Roache 1994; Celik et al. 2008";
  for (const std::string& line : map_in_words(map, pairs))
    study.claim += (study.claim.empty() ? "" : ". ") + line;
  study.about =
      "Both errors are Richardson's estimates for the finest level of their ladder, and follow the "
      "order that was observed. Costs follow the growth from the last level but one to the last.";
  if (!map.reason.empty()) return study;
  study.maps = {drawn_map(map)};
  study.tables = {pairs_table(map, pairs)};
  return study;
}

}  // namespace foldproof
