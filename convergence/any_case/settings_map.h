// How far is a result from its solver's own limit, and which settings reach a wanted error at the
// least cost? A map over one or two tunables of a solver, as substeps and iterations.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "convergence/any_case/error_bar.h"
#include "verification/subjects/pipe/declaration.h"
#include "verification/verdict.h"

namespace foldproof {

/// A tunable as the map refines it.
struct SettingsAxis {
  std::string name;
  TunableKind kind = TunableKind::substeps;
  double first = 1;                  // the value in use
  double least = 1, most = 1 << 20;  // of its values
  bool is_proportional = true;       // costs in proportion to it
  double unit = 1;                   // values are multiples of it, but of a tolerance

  bool falls() const { return kind == TunableKind::tolerance; }  // finer is smaller
  double ratio() const { return falls() ? 10 : 2; }              // of neighbouring levels
  /// The value that is `times` as fine as another; whole, except of a tolerance.
  double finer(double value, double times) const;
  bool has(double value) const { return value >= least && value <= most; }
};

/// A number as 1 x 1. Positions as 3N x F, each row times the root of its particle's fraction of
/// the mass: the norm of a column is the root mean square of a frame [m].
using Seen = Eigen::MatrixXd;

/// The largest norm of a column; NaN if one is.
double size_of(const Seen& seen);

using SettingsPair = std::array<double, 2>;  // values of both tunables; of one alone: {value, 1}

struct SettingsRun {
  SettingsPair at;
  double cost = 0;              // the product of the proportional tunables; else seconds
  double seconds = 0;           // of the processor
  double motion = nan;          // largest distance from the start, root mean square [m]
  std::vector<Seen> seen = {};  // one a quantity
  std::string stopped = {};     // why it came to no end, or ""
};

struct SettingsQuantity {
  std::string name, unit;
  double floor = 0;      // differences up to it are rounding
  Seen truth = {};       // the converged answer of another solver; empty: not known
  double truth_bar = 0;  // of it
};

struct SettingsMap {
  std::vector<SettingsAxis> axes;            // one or two; iterations, or a tolerance, last
  std::vector<SettingsQuantity> quantities;  // positions first
  std::vector<SettingsRun> runs = {};

  const SettingsRun* find(const SettingsPair& at) const;
  double cost() const;  // of all runs
  /// Of all pairs on a grid of doubled values, from the least to the largest values that were run.
  double cost_of_grid() const;
};

/// The limit of a quantity as a solver refines its settings, by Richardson's extrapolation.
struct OwnLimit {
  Seen value;        // empty: not known, or none
  double bar = nan;  // of it, in the quantity's unit
  double scale =
      nan;  // of errors: the motion of positions; of a length that, or the limit, if larger
  double order = nan;   // observed in the first tunable
  double along = 1;     // value of the second tunable at which it was found
  std::string none;     // why there is none; "" if there is, or if it is not known
  std::string unknown;  // why it is not known; or ""
};

/// Of each row of runs at one value of the second tunable that has three values of the first in
/// one ratio; the row with the smallest bar counts. Of iterations, rows must agree: as steps become
/// short, an iteration that belongs to the same equations has less and less to do. Where rows
/// settle elsewhere, beyond their bars, there is no limit. Of a tolerance, the finest row counts.
/// Runs so fine that rounding moves them more than refinement does are left out.
OwnLimit own_limit(const SettingsMap& map, size_t quantity);

/// Whether a row has such runs.
bool is_lost_in_rounding(const SettingsMap& map, size_t quantity, double other);

/// Distance of a run from the limit, over its scale; infinite if the run came to no end.
double error_of(const SettingsRun& run, size_t quantity, const OwnLimit& limit);

/// A pair for a wanted error.
struct PricedPair {
  double wanted = nan;  // 1
  SettingsPair at = {nan, nan};
  double cost = nan, error = nan;  // error: measured, or NaN
  bool was_run = false;            // else interpolated
  std::string because = {};        // why there is none; or ""
};

/// The cheapest pair by the runs that were made: one of them, or between two of a row.
PricedPair cheapest_pair(const SettingsMap& map, size_t quantity, double wanted);

/// Where one row reaches the error for good; cost is NaN where it does not.
PricedPair pair_in_row(const SettingsMap& map, size_t quantity, double other, const OwnLimit& limit,
                       double wanted);

/// Runs what the map needs; not kept in the map by the callee.
using RunSettings = std::function<SettingsRun(const SettingsPair& at)>;

/// Adds the runs that show the quantity's limit and the cheapest pair for each wanted error, the
/// largest first, while their cost is within `most`. Rows at a quarter of, at, and at four times
/// the second tunable's first value are refined in turn, the cheapest run next; rows that cannot
/// become the cheapest any more are left. From the best row on, neighbouring rows are asked at
/// equal cost. Each pair that is named was run.
std::vector<PricedPair> find_pairs(SettingsMap& map, size_t quantity,
                                   const std::vector<double>& wanted, double most,
                                   const RunSettings& run);

enum class Regime { discretisation, unconverged, rounding, unknown };

/// The error of a pair and its parts, over the limit's scale [1].
struct PairError {
  double all = nan;           // from the own limit
  double of_first = nan;      // left when the second tunable has converged
  double of_second = nan;     // due to the second tunable
  double order_second = nan;  // observed
  double from_truth = nan;
  Regime regime = Regime::unknown;
};

/// Adds the runs of the pair's column: the second tunable refined, at most three times, within
/// `most`.
void run_column(SettingsMap& map, const SettingsPair& at, double most, const RunSettings& run);

PairError pair_error(const SettingsMap& map, size_t quantity, const SettingsPair& at,
                     const OwnLimit& limit);

/// Why refining the first tunable ends: that its values beyond one change nothing, that rounding
/// grows, or that differences have sunk to a floor of rounding; "" otherwise.
std::string end_of_refinement(const SettingsMap& map, size_t quantity, const OwnLimit& limit);

}  // namespace foldproof
