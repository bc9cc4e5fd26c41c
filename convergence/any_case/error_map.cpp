#include "convergence/any_case/error_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "convergence/any_case/ladder_cost.h"
#include "reference/dynamics/integrator.h"

namespace foldproof {

namespace {

constexpr double coarsest_edge = 8,
                 finest_edge = 1.0 / 4096;  // edges that are searched, over the case's
constexpr int pairs_an_octave = 64;

/// The step's error may be so many times larger or smaller on another mesh before it is warned of.
constexpr double same_step_error = 2;

/// log2 of the growth from the last level but one to the last.
template <class Number>
double last_growth(const std::vector<Number>& values) {
  return std::log2(double(values.back()) / double(values[values.size() - 2]));
}

/// Richardson's estimate of the error of the finest level, followed back to the first one [m].
PowerLaw error_law(const QuantityOverLevels& positions, double formal_order) {
  const double order = std::min(positions.bar.order, formal_order);
  const double of_finest = std::abs(positions.differences.back()) / (std::exp2(order) - 1);
  return {of_finest * std::exp2(order * double(positions.differences.size())), order};
}

std::string why_no_map(const LadderAnswer& answer, double motion) {
  const ErrorBar& bar = answer.quantities.front().bar;
  if (!(motion > 0)) return "nothing moves";
  if (std::isnan(bar.order))
    return fmt::format("the positions have no order in {}: {}", answer.in, bar.reason);
  return "";
}

void add_warnings(const LadderAnswer& answer, ErrorMap& map) {
  const ErrorBar& bar = answer.quantities.front().bar;
  if (bar.reading != Reading::asymptotic)
    map.warnings.push_back(
        fmt::format("the order in {}, {:.2f}, is not asymptotic ({}): the map is rough", answer.in,
                    bar.order, bar.reason));
}

void compare_step_errors(const LadderAnswer& in_space, ErrorMap& map) {
  const double there = in_space.quantities.front().step_error / map.motion;
  map.step_error_ratio = there / map.step_error.at(in_space.mean_step / map.step);
  if (!(map.step_error_ratio <= same_step_error && map.step_error_ratio >= 1 / same_step_error))
    map.warnings.push_back(
        fmt::format("the step's error is {:.2g} times as large on the second-finest mesh as on the "
                    "case's own: the sum of both errors is as uncertain as that",
                    map.step_error_ratio));
}

std::vector<double> costs(const LadderAnswer& answer) {
  std::vector<double> all;
  for (size_t k = 0; k < answer.work.size(); ++k) all.push_back(answer.cost(k));
  return all;
}

/// The longest step for the wanted error on this mesh; NaN where the mesh alone exceeds it.
double step_for(const ErrorMap& map, double wanted, double dx) {
  const double left = wanted - map.mesh_error.at(dx / map.edge);
  if (!(left > 0)) return nan;
  const double h = map.step * std::pow(left / map.step_error.as_it_is, 1 / map.step_error.exponent);
  return std::min(h, map.longest_step(dx));
}

CheapestPair search(const ErrorMap& map, double wanted) {
  CheapestPair best{wanted, nan, nan, nan, INFINITY, nan, false};
  const int count = int(std::log2(coarsest_edge / finest_edge)) * pairs_an_octave + 1;
  for (int k = 0; k < count; ++k) {
    const double dx = coarsest_edge * map.edge * std::pow(std::exp2(-1.0 / pairs_an_octave), k);
    const double h = step_for(map, wanted, dx);
    if (const double seconds = map.seconds(h, dx); seconds < best.seconds) {
      best.step = h;
      best.edge = dx;
      best.seconds = seconds;
      best.is_limited_by_rule = h >= map.longest_step(dx);
    }
  }
  return best;
}

}  // namespace

double PowerLaw::at(double size) const { return as_it_is * std::pow(size, exponent); }

double ErrorMap::error(double h, double dx) const {
  return step_error.at(h / step) + mesh_error.at(dx / edge);
}

double ErrorMap::seconds(double h, double dx) const {
  return seconds_by_work * work * std::pow(h / step, -work_by_step) *
         std::pow(dx / edge, -work_by_edge);
}

double ErrorMap::longest_step(double dx) const {
  return step * std::pow(dx / edge, longest_by_edge);
}

ErrorMap error_map(const LadderAnswer& in_time, const LadderAnswer& in_space, double motion) {
  ErrorMap map;
  map.scene = in_time.scene;
  map.method = in_time.method;
  map.step = in_time.sizes.front();
  map.edge = in_space.sizes.front();
  map.motion = motion;
  for (const LadderAnswer* answer : {&in_time, &in_space})
    if (map.reason.empty()) map.reason = why_no_map(*answer, motion);
  if (!map.reason.empty()) return map;

  map.step_error = error_law(in_time.quantities.front(), integrator_named(in_time.method).order);
  map.mesh_error = error_law(in_space.quantities.front(), order_in_space);
  map.step_error.as_it_is /= motion;
  map.mesh_error.as_it_is /= motion;

  map.work = in_time.cost(0);
  map.work_by_step = last_growth(costs(in_time));
  map.work_by_edge = last_growth(costs(in_space));
  map.seconds_by_work = in_space.seconds.back() / costs(in_space).back();
  map.particles = in_space.particles.front();
  map.particles_by_edge = last_growth(in_space.particles);
  map.longest_by_edge =
      std::log2(map.step / in_space.mean_step) / double(in_space.sizes.size() - 1);

  for (const LadderAnswer* answer : {&in_time, &in_space}) add_warnings(*answer, map);
  compare_step_errors(in_space, map);
  return map;
}

CheapestPair cheapest_pair(const ErrorMap& map, double wanted) {
  CheapestPair best = search(map, wanted);
  if (std::isnan(best.edge)) {
    best.seconds = nan;
    return best;
  }
  best.particles = map.particles * std::pow(best.edge / map.edge, -map.particles_by_edge);
  best.halving_costs = search(map, wanted / 2).seconds / best.seconds;
  return best;
}

std::vector<std::string> map_in_words(const ErrorMap& map, const std::vector<CheapestPair>& pairs) {
  if (!map.reason.empty()) return {"No map of error over step and mesh: " + map.reason + "."};
  std::vector<std::string> lines = {
      fmt::format("error over the motion ({:.3g} m): {:.2g} % (h / {:.3g} s)^{:.2f} + {:.2g} % (dx "
                  "/ {:.3g} m)^{:.2f}",
                  map.motion, 100 * map.step_error.as_it_is, map.step, map.step_error.exponent,
                  100 * map.mesh_error.as_it_is, map.edge, map.mesh_error.exponent),
      fmt::format("cost: {} (h / {:.3g} s)^{:.2f} (dx / {:.3g} m)^{:.2f}; the case's own rule "
                  "takes h <= {:.3g} s (dx / {:.3g} m)^{:.2f}",
                  duration_text(map.seconds(map.step, map.edge)), map.step, -map.work_by_step,
                  map.edge, -map.work_by_edge, map.step, map.edge, map.longest_by_edge)};
  for (const CheapestPair& pair : pairs) {
    if (std::isnan(pair.edge)) {
      lines.push_back(
          fmt::format("{:.3g} %: no mesh of edges from {:g} to 1/{:g} of the case's own",
                      100 * pair.wanted, coarsest_edge, 1 / finest_edge));
      continue;
    }
    lines.push_back(fmt::format(
        "{:.3g} %: cheapest with dx = {:.3g} m and h = {:.3g} s{}: {:.3g} times the particles, {} "
        "of one processor; half that error costs {:.3g} times as much",
        100 * pair.wanted, pair.edge, pair.step,
        pair.is_limited_by_rule ? ", the longest that the rule takes" : "",
        pair.particles / map.particles, duration_text(pair.seconds), pair.halving_costs));
  }
  for (const std::string& warning : map.warnings) lines.push_back("warning: " + warning);
  return lines;
}

// The map as evidence: a heat map, lines of equal cost, tables.

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
  Table table(
      "wanted error [1]; step [s]; edge [m]; particles [1]; processor time [s]; over the case as "
      "it is [1]; for half of it [1]");
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
