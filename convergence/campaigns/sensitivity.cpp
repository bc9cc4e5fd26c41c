#include "convergence/campaigns/sensitivity.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace foldproof {

namespace {

constexpr size_t fewest_samples = 40, groups = 20;

/// Kelley's epsilon squared of values in the order of x:
///
///   (B - (M - 1) W / (n - M)) / T     B, W, T: squares between bins, within bins, in all
///
/// Pure chance gives B the mean (M - 1) W / (n - M), which is taken away.
double epsilon_squared(std::span<const double> y, size_t bins) {
  const size_t n = y.size();
  double mean = 0;
  for (const double value : y) mean += value / double(n);
  double between = 0, within = 0;
  for (size_t bin = 0; bin < bins; ++bin) {
    const auto in_bin = y.subspan(bin * n / bins, (bin + 1) * n / bins - bin * n / bins);
    double bin_mean = 0;
    for (const double value : in_bin) bin_mean += value / double(in_bin.size());
    between += double(in_bin.size()) * (bin_mean - mean) * (bin_mean - mean);
    for (const double value : in_bin) within += (value - bin_mean) * (value - bin_mean);
  }
  const double by_chance = double(bins - 1) * within / double(n - bins);
  return (between - by_chance) / (between + within);
}

/// The jackknife over groups, each of every 20th value.
double standard_error(const std::vector<double>& y, size_t bins) {
  std::vector<double> left_out;
  double mean = 0;
  for (size_t group = 0; group < groups; ++group) {
    std::vector<double> rest;
    for (size_t k = 0; k < y.size(); ++k)
      if (k % groups != group) rest.push_back(y[k]);
    left_out.push_back(epsilon_squared(rest, bins));
    mean += left_out.back() / double(groups);
  }
  double squares = 0;
  for (const double value : left_out) squares += (value - mean) * (value - mean);
  return std::sqrt(squares * double(groups - 1) / double(groups));
}

}  // namespace

FirstOrderIndex first_order_index(std::span<const double> x, std::span<const double> y) {
  std::vector<size_t> order;
  for (size_t k = 0; k < y.size(); ++k)
    if (!std::isnan(y[k])) order.push_back(k);
  std::ranges::stable_sort(order, {}, [&](size_t k) { return x[k]; });
  std::vector<double> sorted;
  for (const size_t k : order) sorted.push_back(y[k]);
  const size_t bins = size_t(std::sqrt(double(sorted.size())));
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  FirstOrderIndex found{unknown, unknown, sorted.size(), bins};
  if (sorted.size() < fewest_samples) return found;
  const auto [least, most] = std::ranges::minmax(sorted);
  if (!(most > least)) return found;
  found.index = epsilon_squared(sorted, bins);
  found.error = standard_error(sorted, bins);
  return found;
}

}  // namespace foldproof
