// Observed orders: what errors at a row of steps say about the rate at which they fall, and when
// they say nothing.
#pragma once

#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "verification/oracles/estimate.h"
#include "verification/verdict.h"

namespace foldproof {

using oracles::Estimate;

/// Errors over a row of steps. steps: n values, falling, > 0 (any unit); errors: n values, >= 0.
struct Convergence {
  std::vector<double> steps;
  std::vector<double> errors;
  double floor = 0;  // how far each error may be off, its reference being so [unit of the errors]
};

/// A refinement study in one call: runs each level, coarse to fine, and gives the table of what was
/// measured. columns: names and units, no rows; run(level) gives a level's row as a std::tuple or
/// std::array, its step first.
///
///   const Table measured =
///       refine({{"width of a cell", "m"}, {"error", "1"}}, doubled(6, 96),
///              [&](int cells) { return std::tuple{width / cells, error_with(cells)}; });
template <class Level, class Run>
Table refine(Table columns, const std::vector<Level>& levels, const Run& run) {
  for (const Level& level : levels)
    std::apply([&](const auto&... cells) { columns.row(cells...); }, run(level));
  return columns;
}

/// A column of a refinement's table as errors over its first column, the steps; without a floor.
Convergence convergence_of(const Table& refined, std::string_view errors);

/// log(e_i/e_{i+1}) / log(h_i/h_{i+1}) of each neighbouring pair, n - 1 values; NaN where an error
/// is not > 0. Throws InputError unless there are as many errors as steps, two at least, and the
/// steps fall and are > 0.
std::vector<double> pair_orders(const Convergence& convergence);

/// The same, one a row: the order of the pair that ends there; NaN in the first row.
std::vector<double> row_orders(const Convergence& convergence);

/// Errors over steps, with the orders of their pairs; without a floor if that is 0.
Curve curve_of(const std::string& label, const Convergence& convergence);

/// The slope of log error over log step by least squares over all points; NaN where an error
/// is zero or NaN.
double fitted_order(const Convergence& convergence);

/// The largest |order - expected| over the last `pairs` pairs, and how far the floor can shift it:
/// each error e may be anything in [e - floor, e + floor], so the uncertainty is infinite once one
/// has sunk to it. Throws InputError when there are fewer pairs.
Estimate order_deviation(const Convergence& convergence, double expected, int pairs);

/// A verdict on that deviation.
Verdict order_verdict(const Convergence& convergence, double expected, int pairs, double bound,
                      std::string why_bound);

/// The limit h -> 0 of values that err by c h^order, from two whose steps differ by the
/// factor ratio > 1:
///   fine + (fine - coarse)/(ratio^order - 1)
/// The uncertainty is the size of that correction: the next term of the error is not known.
Estimate richardson(double coarse, double fine, double ratio, double order);

/// Index of the first pair from which on every order lies within `within` of the expected one:
/// there the asymptotic range begins. The number of pairs if the last order does not.
int asymptotic_from(const std::vector<double>& orders, double expected, double within);

/// How many leading levels have errors above factor * floor; the first that has not, or
/// is NaN, ends it.
int levels_above_floor(const Convergence& convergence, double factor);

}  // namespace foldproof
