// Which runs show the limit and the cheapest pair, for less than a full grid costs?
#include <algorithm>
#include <cmath>

#include "convergence/any_case/settings_map.h"

namespace foldproof {

namespace {

constexpr double steepest = 2;          // order at which errors may fall beyond the runs so far [1]
constexpr double limit_part = 1.0 / 3;  // of a wanted error that the limit's bar may have
constexpr double row_spacing = 4;       // of the first rows' second values
constexpr int most_confirmed = 4;       // pairs that are run to name one
constexpr int most_values = 5;          // of a first row whose price is not known before

/// The search for one quantity's pairs.
class Search {
 public:
  Search(SettingsMap& map, size_t quantity, double most, const RunSettings& run)
      : map_(map), quantity_(quantity), most_(most), run_(run) {}

  PricedPair pair_for(double wanted) {
    refine_rows(wanted);
    PricedPair best = cheapest_pair(map_, quantity_, wanted);
    if (!best.because.empty()) return best;
    best = confirmed(best);
    for (bool better = map_.axes.size() > 1; better;) {
      better = false;
      const double ratio = map_.axes[1].ratio();
      for (const double times : {1 / ratio, ratio})
        if (!better && tries_row(times, best)) better = true;
    }
    return best;
  }

 private:
  bool is_affordable(double cost) const { return map_.cost() + cost <= most_; }

  double forecast(const SettingsPair& at) const {
    double cost = 1;
    for (size_t axis = 0; axis < map_.axes.size(); ++axis)
      if (map_.axes[axis].is_proportional) cost *= at[axis];
    const SettingsRun* near = nullptr;  // of a cost that is no product: the last in the row
    for (const SettingsRun& one : map_.runs)
      if (one.at[1] == at[1]) near = &one;
    if (map_.axes[0].is_proportional || !near) return cost;
    return near->cost * std::max(at[0] / near->at[0], near->at[0] / at[0]);
  }

  /// Whether it is there now, in range and within the cost.
  bool make(const SettingsPair& at) {
    if (map_.find(at)) return true;
    for (size_t axis = 0; axis < map_.axes.size(); ++axis)
      if (!map_.axes[axis].has(at[axis])) return false;
    if (!is_affordable(forecast(at))) return false;
    map_.runs.push_back(run_(at));
    return true;
  }

  /// The values of the second tunable at which rows begin.
  std::vector<double> first_rows() const {
    if (map_.axes.size() < 2) return {1};
    const SettingsAxis& second = map_.axes[1];
    std::vector<double> rows;
    for (const double times : {1 / row_spacing, 1.0, row_spacing}) {
      const double value = second.finer(second.first, times);
      if (second.has(value) && !std::ranges::count(rows, value)) rows.push_back(value);
    }
    return rows;
  }

  /// The finest run of a row; null where none was made.
  const SettingsRun* last_of(double other) const {
    const SettingsRun* last = nullptr;
    for (const SettingsRun& run : map_.runs)
      if (run.at[1] == other &&
          (!last || (map_.axes[0].falls() ? run.at[0] < last->at[0] : run.at[0] > last->at[0])))
        last = &run;
    return last;
  }

  long runs_of(double other) const {
    return std::ranges::count_if(map_.runs,
                                 [&](const SettingsRun& run) { return run.at[1] == other; });
  }

  /// The pair that refines the row next.
  SettingsPair next_of(double other) const {
    const SettingsRun* last = last_of(other);
    const SettingsAxis& first = map_.axes[0];
    return {last ? first.finer(last->at[0], first.ratio()) : first.first, other};
  }

  /// A lower bound on the cost of a row for the error: its errors fall as steeply as they may.
  double least_price(double other, const OwnLimit& limit, double wanted) const {
    const SettingsRun* last = last_of(other);
    if (!last || limit.value.size() == 0) return 0;
    const double error = error_of(*last, quantity_, limit);
    return std::isfinite(error) ? last->cost * std::max(1.0, std::pow(error / wanted, 1 / steepest))
                                : 0;
  }

  bool is_known(const OwnLimit& limit, double wanted) const {
    return limit.unknown.empty() && limit.value.size() > 0 &&
           limit.bar <= limit_part * wanted * limit.scale;
  }

  /// The cheapest run that may serve, of all rows.
  void refine_rows(double wanted) {
    const std::vector<double> rows = first_rows();
    for (int k = 0; k < 3; ++k)
      for (const double row : rows) {
        if (k == 0)
          make({map_.axes[0].first, row});
        else if (map_.axes[0].is_proportional || runs_of(row) < most_values)
          make(next_of(row));
      }
    while (true) {
      const OwnLimit limit = own_limit(map_, quantity_);
      if (!limit.none.empty()) return;
      const PricedPair found = cheapest_pair(map_, quantity_, wanted);
      if (is_known(limit, wanted) && found.because.empty()) return;
      SettingsPair best{};
      double least = INFINITY;
      for (const double row : rows) {
        const SettingsPair next = next_of(row);
        const double cost = forecast(next);
        const bool is_of_limit = limit.value.size() > 0 && row == limit.along;
        if (!is_of_limit && found.because.empty()) continue;
        if (is_lost_in_rounding(map_, quantity_, row)) continue;
        if (!is_of_limit && least_price(row, limit, wanted) > found.cost) continue;
        if (cost < least && is_affordable(cost) && map_.axes[0].has(next[0]))
          least = cost, best = next;
      }
      if (!std::isfinite(least) || !make(best)) return;
    }
  }

  /// Runs the pair, and finer ones while it misses the error.
  PricedPair confirmed(PricedPair pair) {
    for (int k = 0; k < most_confirmed && !pair.was_run; ++k) {
      if (!make(pair.at)) return pair;
      pair = cheapest_pair(map_, quantity_, pair.wanted);
      if (!pair.because.empty()) return pair;
    }
    return pair;
  }

  /// Whether the row of so many times the second value serves at a cost that is a tenth less.
  bool tries_row(double times, PricedPair& best) {
    const double other = map_.axes[1].finer(best.at[1], times);
    if (other == best.at[1] || !map_.axes[1].has(other)) return false;
    const SettingsAxis& first = map_.axes[0];
    SettingsPair at{best.at[0], other};
    if (!first.falls())
      at[0] = std::min(first.finer(best.at[0], 0.9 * best.at[1] / other), first.most);
    if (at[0] < first.least || !make(at)) return false;
    // while it serves, half as many show where the row begins to
    while (error_of(*map_.find(at), quantity_, own_limit(map_, quantity_)) <= best.wanted) {
      at[0] = first.finer(at[0], 1 / first.ratio());
      if (map_.find(at) || !make(at)) break;
    }
    const PricedPair found = confirmed(cheapest_pair(map_, quantity_, best.wanted));
    if (!found.because.empty() || !(found.cost < 0.9 * best.cost)) return false;
    best = found;
    return true;
  }

  SettingsMap& map_;
  size_t quantity_;
  double most_;
  const RunSettings& run_;
};

}  // namespace

std::vector<PricedPair> find_pairs(SettingsMap& map, size_t quantity,
                                   const std::vector<double>& wanted, double most,
                                   const RunSettings& run) {
  Search search(map, quantity, most, run);
  std::vector<PricedPair> pairs;
  for (const double error : wanted) search.pair_for(error);
  // by then the limit is better known
  for (const double error : wanted) pairs.push_back(search.pair_for(error));
  return pairs;
}

void run_column(SettingsMap& map, const SettingsPair& at, double most, const RunSettings& run) {
  if (map.axes.size() < 2) return;
  const SettingsAxis& second = map.axes[1];
  SettingsPair next = at;
  for (int k = 0; k < 4; ++k, next[1] = second.finer(next[1], second.ratio())) {
    if (map.find(next)) continue;
    if (!second.has(next[1]) || (k > 0 && map.cost() >= most)) return;
    map.runs.push_back(run(next));
  }
}

}  // namespace foldproof
