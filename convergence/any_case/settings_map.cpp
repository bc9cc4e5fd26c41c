#include "convergence/any_case/settings_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "convergence/any_case/level_run.h"

namespace foldproof {

namespace {

constexpr double same_value = 1e-9;  // of two settings [1]
// Of the change from one extrapolated limit to the next: if the next term is of half an order more,
// 2.4 times the change is left. [1]
constexpr double limit_safety = 3;
constexpr double much_larger = 4;        // than the smallest difference: rounding has grown [1]
constexpr double visible = 1e-3;         // distance of limits that matters, over the scale [1]
constexpr double highest_order = 4;      // that is extrapolated with
constexpr double single_floor = 1.2e-4;  // 1e3 roundings of single precision [1]

bool are_same(double a, double b) { return std::abs(a - b) <= same_value * std::abs(b); }

/// Runs of a row, or a column, that came to an end, coarse to fine in `axis`.
using Row = std::vector<const SettingsRun*>;

Row row_of(const SettingsMap& map, size_t axis, double at_other) {
  Row row;
  for (const SettingsRun& run : map.runs)
    if (run.stopped.empty() && are_same(run.at[1 - axis], at_other)) row.push_back(&run);
  const bool falls = axis < map.axes.size() && map.axes[axis].falls();
  std::ranges::sort(row, [&](auto* a, auto* b) {
    return falls ? a->at[axis] > b->at[axis] : a->at[axis] < b->at[axis];
  });
  return row;
}

std::vector<double> others_of(const SettingsMap& map) {
  std::vector<double> values;
  for (const SettingsRun& run : map.runs)
    if (std::ranges::none_of(values, [&](double v) { return are_same(v, run.at[1]); }))
      values.push_back(run.at[1]);
  std::ranges::sort(values);
  return values;
}

/// The longest chain of values in one ratio that ends at the finest.
struct Chain {
  Row runs;
  double ratio = 2;
};

Chain chain_of(const Row& row, size_t axis) {
  Chain longest;
  if (row.empty()) return longest;
  const double last = row.back()->at[axis];
  for (const SettingsRun* next : row) {
    const double ratio = last / next->at[axis];
    if (are_same(ratio, 1)) continue;
    Chain chain{{row.back()}, ratio > 1 ? ratio : 1 / ratio};
    for (double value = next->at[axis];; value /= ratio) {
      const auto found = std::ranges::find_if(
          row, [&](const SettingsRun* run) { return are_same(run->at[axis], value); });
      if (found == row.end()) break;
      chain.runs.insert(chain.runs.begin(), *found);
    }
    if (chain.runs.size() > longest.runs.size()) longest = chain;
  }
  return longest;
}

/// The limit of a chain of runs.
struct ChainLimit {
  Seen value;
  double bar = nan;
  ErrorBar read;
  double motion = nan;  // m
  double along = 1;
  bool is_good() const { return read.reading == Reading::asymptotic; }
};

/// Signed for numbers, so that a change of sign shows.
double difference(const Seen& fine, const Seen& coarse) {
  return fine.size() == 1 ? fine(0, 0) - coarse(0, 0) : size_of(fine - coarse);
}

Seen extrapolated(const Seen& coarse, const Seen& fine, double ratio, double order) {
  return fine + (fine - coarse) / (std::pow(ratio, std::min(order, highest_order)) - 1);
}

/// With the order that is observed as the formal one: a solver's settings promise none.
ErrorBar read_chain(const std::vector<double>& d, double ratio, double floor) {
  const double a = d[d.size() - 2], b = d.back();
  const double last = a * b > 0 ? std::log(a / b) / std::log(ratio) : 1;
  return error_bar({{}, d, ratio, std::clamp(std::round(last), 1.0, highest_order), floor});
}

/// The difference from which on rounding outgrows what refinement gains, as in single precision. It
/// is the smallest, ends a fall of runs that have not blown up, and others exceed it by far
/// afterwards. None: 0, since a fall has two differences before it.
size_t onset_of_rounding(const Chain& chain, size_t quantity) {
  std::vector<double> d;
  for (size_t k = 0; k + 1 < chain.runs.size(); ++k)
    d.push_back(size_of(chain.runs[k + 1]->seen[quantity] - chain.runs[k]->seen[quantity]));
  const auto least = std::ranges::min_element(d);
  const size_t m = size_t(least - d.begin());
  if (m < 2 || m + 2 >= d.size()) return 0;
  const bool falls = d[m - 2] > d[m - 1] && d[m - 1] > d[m];
  const bool is_stable = d[m - 2] <= size_of(chain.runs[m]->seen[quantity]);
  return falls && is_stable && *std::max_element(least, d.end()) > much_larger * d[m] ? m : 0;
}

/// Of the runs before rounding outgrows refinement. Their last difference may be small only since
/// both gains cancel in it: then the bar is at least twice the one before.
std::optional<ChainLimit> limit_of(Chain chain, size_t quantity, double floor) {
  if (const size_t last = onset_of_rounding(chain, quantity); last > 0) {
    chain.runs.resize(last + 2);
    auto limit = limit_of(chain, quantity, floor);
    const Seen &fine = chain.runs[last]->seen[quantity],
               &coarse = chain.runs[last - 1]->seen[quantity];
    limit->bar = std::max(limit->bar, 2 * size_of(fine - coarse));
    return limit;
  }
  const size_t n = chain.runs.size();
  if (n < 3) return {};
  const auto seen = [&](size_t k) -> const Seen& { return chain.runs[k]->seen[quantity]; };
  std::vector<double> d;
  for (size_t k = 0; k + 1 < n; ++k) d.push_back(difference(seen(k + 1), seen(k)));
  ChainLimit limit{seen(n - 1), nan, read_chain(d, chain.ratio, floor), chain.runs.back()->motion};
  limit.bar = limit.read.half_width;
  if (!(limit.read.order >= least_order)) return limit;
  limit.value = extrapolated(seen(n - 2), seen(n - 1), chain.ratio, limit.read.order);
  const std::vector<double>& orders = limit.read.orders;
  if (const double before = orders.size() > 1 ? orders[orders.size() - 2] : nan;
      before >= least_order) {
    const Seen last = extrapolated(seen(n - 3), seen(n - 2), chain.ratio, before);
    limit.bar = std::min(limit.bar, std::max(limit_safety * size_of(limit.value - last), floor));
  }
  return limit;
}

std::vector<ChainLimit> limits_of_rows(const SettingsMap& map, size_t quantity) {
  std::vector<ChainLimit> limits;
  for (const double other : others_of(map))
    if (auto limit = limit_of(chain_of(row_of(map, 0, other), 0), quantity,
                              map.quantities[quantity].floor)) {
      limit->along = other;
      limits.push_back(std::move(*limit));
    }
  return limits;
}

/// Of a length the motion, else the limit's own size. Runs that have blown up move farther: the
/// motion is that of the limit's runs.
double scale_of(const SettingsMap& map, size_t quantity, const ChainLimit& limit) {
  if (map.quantities[quantity].unit != "m") return size_of(limit.value);
  return limit.value.size() == 1 ? std::max(limit.motion, size_of(limit.value)) : limit.motion;
}

std::string value_text(const Seen& value) {
  return value.size() == 1 ? fmt::format("{:.4g}", value(0, 0)) : "another place";
}

/// Rows that have settled elsewhere than their neighbours; "" if the rows may agree.
std::string rows_disagree(const SettingsMap& map, const std::vector<ChainLimit>& limits,
                          double scale) {
  if (map.axes.size() < 2 || map.axes[1].kind != TunableKind::iterations) return "";
  int apart = 0;
  std::string where;
  const ChainLimit* before = nullptr;
  for (const ChainLimit& limit : limits) {
    if (!limit.is_good()) continue;
    if (before) {
      const double distance = size_of(limit.value - before->value);
      if (!(distance > 2 * (limit.bar + before->bar) && distance > visible * scale)) return "";
      ++apart;
    }
    where += fmt::format("{}{} at {:g}", where.empty() ? "" : ", ", value_text(limit.value),
                         limit.along);
    before = &limit;
  }
  if (apart < 1) return "";
  return fmt::format("its limit depends on {}: {}", map.axes[1].name, where);
}

}  // namespace

double SettingsAxis::finer(double value, double times) const {
  return falls() ? value / times : std::max(unit, unit * std::round(value * times / unit));
}

double size_of(const Seen& seen) {
  Worst worst;
  for (const auto& column : seen.colwise()) worst.observe(column.norm());
  return seen.size() == 0 ? nan : worst.value();
}

const SettingsRun* SettingsMap::find(const SettingsPair& at) const {
  const auto found = std::ranges::find_if(runs, [&](const SettingsRun& run) {
    return are_same(run.at[0], at[0]) && are_same(run.at[1], at[1]);
  });
  return found == runs.end() ? nullptr : &*found;
}

double SettingsMap::cost() const {
  double sum = 0;
  for (const SettingsRun& run : runs) sum += run.cost;
  return sum;
}

double SettingsMap::cost_of_grid() const {
  double all = 1;
  for (size_t axis = 0; axis < axes.size(); ++axis) {
    double least = INFINITY, most = 0, sum = 0;
    for (const SettingsRun& run : runs)
      least = std::min(least, run.at[axis]), most = std::max(most, run.at[axis]);
    for (double value = least; value <= most * (1 + same_value); value *= axes[axis].ratio())
      sum += axes[axis].is_proportional ? value : 1;
    all *= sum;
  }
  return all;
}

OwnLimit own_limit(const SettingsMap& map, size_t quantity) {
  const std::vector<ChainLimit> limits = limits_of_rows(map, quantity);
  OwnLimit own;
  if (limits.empty()) {
    own.unknown = fmt::format("no three values of {} in one ratio came to an end{}",
                              map.axes[0].name, map.axes.size() > 1 ? " in one row" : "");
    return own;
  }
  const bool by_fineness = map.axes.size() > 1 && map.axes[1].falls();
  const ChainLimit& best = by_fineness
                               ? limits.front()
                               : *std::ranges::min_element(limits, {}, [](const ChainLimit& limit) {
                                   return std::isfinite(limit.bar) ? limit.bar : INFINITY;
                                 });
  own.scale = scale_of(map, quantity, best);
  own.none = rows_disagree(map, limits, own.scale);
  if (!own.none.empty()) return own;
  own.value = best.value, own.bar = best.bar, own.order = best.read.order, own.along = best.along;
  if (by_fineness && limits.size() > 1) own.bar += size_of(limits[1].value - best.value);
  if (!(own.bar <= 0.5 * own.scale))
    own.unknown =
        fmt::format("rows of {} have not settled: {}", map.axes[0].name, in_words(best.read));
  return own;
}

bool is_lost_in_rounding(const SettingsMap& map, size_t quantity, double other) {
  return onset_of_rounding(chain_of(row_of(map, 0, other), 0), quantity) > 0;
}

double error_of(const SettingsRun& run, size_t quantity, const OwnLimit& limit) {
  if (!run.stopped.empty()) return INFINITY;
  const double error = size_of(run.seen[quantity] - limit.value) / limit.scale;
  return std::isnan(error) ? INFINITY : error;
}

PricedPair pair_in_row(const SettingsMap& map, size_t quantity, double other, const OwnLimit& limit,
                       double wanted) {
  Row row = row_of(map, 0, other);
  const Chain chain = chain_of(row, 0);
  if (const size_t last = onset_of_rounding(chain, quantity); last > 0)
    row.erase(std::ranges::find(row, chain.runs[last + 1]) + 1, row.end());
  size_t first = row.size();  // from here on, all runs reach it
  while (first > 0 && error_of(*row[first - 1], quantity, limit) <= wanted) --first;
  if (first == row.size()) return {wanted};
  const SettingsRun& fine = *row[first];
  PricedPair pair{wanted, fine.at, fine.cost, error_of(fine, quantity, limit), true};
  if (first == 0) return pair;
  // in logarithms between the runs on both sides
  const SettingsRun& coarse = *row[first - 1];
  const double above = error_of(coarse, quantity, limit), ratio = fine.at[0] / coarse.at[0];
  const double part = std::log(above / wanted) / std::log(above / pair.error);
  const double unit = map.axes[0].unit, exact = coarse.at[0] * std::pow(ratio, part);
  const double value = map.axes[0].falls() ? exact : unit * std::ceil(exact / unit - same_value);
  if (are_same(value, fine.at[0]) || !std::isfinite(value)) return pair;
  pair.cost = coarse.cost *
              std::pow(fine.cost / coarse.cost, std::log(value / coarse.at[0]) / std::log(ratio));
  pair.at[0] = value, pair.was_run = false, pair.error = nan;
  return pair;
}

PricedPair cheapest_pair(const SettingsMap& map, size_t quantity, double wanted) {
  const OwnLimit limit = own_limit(map, quantity);
  PricedPair best{wanted};
  if (!limit.none.empty() || !limit.unknown.empty()) {
    best.because = limit.none + limit.unknown;
    return best;
  }
  std::vector<double> others = others_of(map);
  if (map.axes.size() > 1)  // the value in use comes first, which wins where costs are equal
    std::ranges::stable_partition(others,
                                  [&](double other) { return are_same(other, map.axes[1].first); });
  for (const double other : others)
    if (PricedPair pair = pair_in_row(map, quantity, other, limit, wanted);
        std::isfinite(pair.cost) && !(pair.cost >= best.cost))
      best = std::move(pair);
  if (std::isnan(best.cost)) best.because = "no run reaches it";
  if (limit.bar > wanted * limit.scale) {
    best = {wanted};
    best.because =
        fmt::format("the limit is known to {:.2g} % only", 100 * limit.bar / limit.scale);
  }
  return best;
}

PairError pair_error(const SettingsMap& map, size_t quantity, const SettingsPair& at,
                     const OwnLimit& limit) {
  PairError error;
  const SettingsRun* run = map.find(at);
  if (!run || !run->stopped.empty() || limit.value.size() == 0) return error;
  error.all = error_of(*run, quantity, limit);
  const SettingsQuantity& q = map.quantities[quantity];
  if (q.truth.size() > 0) error.from_truth = size_of(run->seen[quantity] - q.truth) / limit.scale;
  const auto column = limit_of(chain_of(row_of(map, 1, at[0]), 1), quantity, q.floor);
  if (map.axes.size() > 1 && column) {
    error.of_first = size_of(column->value - limit.value) / limit.scale;
    error.of_second = size_of(run->seen[quantity] - column->value) / limit.scale;
    error.order_second = column->read.order;
    error.regime = error.of_second > error.of_first ? Regime::unconverged : Regime::discretisation;
  } else if (map.axes.size() == 1) {
    const bool solves = map.axes[0].kind == TunableKind::iterations || map.axes[0].falls();
    (solves ? error.of_second : error.of_first) = error.all;
    error.regime = solves ? Regime::unconverged : Regime::discretisation;
  }
  if (error.all * limit.scale <= floors_for_order * q.floor) error.regime = Regime::rounding;
  return error;
}

namespace {

/// Whether the last two differences are no smaller than half of the one before: of first order they
/// would be three eighths.
bool has_stalled(const std::vector<double>& d) {
  const size_t n = d.size();
  return n > 2 && d[n - 1] + d[n - 2] > d[n - 3];
}

}  // namespace

std::string end_of_refinement(const SettingsMap& map, size_t quantity, const OwnLimit& limit) {
  for (const double other : others_of(map)) {
    const Chain chain = chain_of(row_of(map, 0, other), 0);
    if (chain.runs.size() < 3) continue;
    if (const size_t last = onset_of_rounding(chain, quantity); last > 0)
      return fmt::format("beyond {:g} {}, rounding moves it more than refinement does",
                         chain.runs[last + 1]->at[0], map.axes[0].name);
    std::vector<double> d;
    for (size_t k = 0; k + 1 < chain.runs.size(); ++k)
      d.push_back(size_of(chain.runs[k + 1]->seen[quantity] - chain.runs[k]->seen[quantity]));
    const double largest = *std::ranges::max_element(d), last = d.back(), before = d[d.size() - 2];
    if (last == 0 && largest > 0) {
      const auto zero = std::ranges::find(d, 0.0) - d.begin();
      return fmt::format("{} beyond {:g} change nothing", map.axes[0].name,
                         chain.runs[size_t(zero)]->at[0]);
    }
    if (has_stalled(d) && largest > 10 * last && last < single_floor * limit.scale * 10)
      return fmt::format("beyond {:g} {}, differences stay at {:.2g} % of it: a floor of rounding",
                         chain.runs[chain.runs.size() - 3]->at[0], map.axes[0].name,
                         100 * std::max(last, before) / limit.scale);
  }
  return "";
}

}  // namespace foldproof
