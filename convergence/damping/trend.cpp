#include "convergence/damping/artificial_damping.h"

#include <algorithm>
#include <cmath>

#include "reference/types.h"

namespace foldproof {

namespace {

/// Fills times and means.
void average(const std::vector<double>& times, const std::vector<double>& values, int blocks,
             Trend& trend) {
  const double start = times.front(), span = (times.back() - start) / blocks;
  std::vector<double> sums(size_t(blocks), 0), counts = sums;
  for (size_t i = 0; i < times.size(); ++i) {
    const int block = std::min(blocks - 1, int((times[i] - start) / span));
    sums[size_t(block)] += values[i];
    ++counts[size_t(block)];
  }
  for (int k = 0; k < blocks; ++k) {
    if (counts[size_t(k)] == 0)
      throw InputError("trend_of: a block has no sample; take fewer blocks");
    trend.times.push_back(start + (k + 0.5) * span);
    trend.means.push_back(sums[size_t(k)] / counts[size_t(k)]);
  }
}

}  // namespace

Trend trend_of(const std::vector<double>& times, const std::vector<double>& values, int blocks) {
  if (times.size() != values.size() || blocks < 3 || times.empty() ||
      !(times.back() > times.front()))
    throw InputError(
        "trend_of: needs as many times as values, in ascending order, and at least three blocks");
  Trend trend;
  average(times, values, blocks, trend);

  const Eigen::Map<const PerParticle> t(trend.times.data(), blocks), y(trend.means.data(), blocks);
  const PerParticle centred = t.array() - t.mean();
  trend.slope = centred.dot(y) / centred.squaredNorm();
  const PerParticle scatter = (y.array() - y.mean()).matrix() - trend.slope * centred;
  const double lag_one =
      scatter.head(blocks - 1).dot(scatter.tail(blocks - 1)) / scatter.squaredNorm();
  const double enlarged = lag_one > 0 ? std::sqrt((1 + lag_one) / (1 - lag_one)) : 1;
  trend.error = enlarged * std::sqrt(scatter.squaredNorm() / (blocks - 2) / centred.squaredNorm());
  return trend;
}

std::vector<double> thin_out(const std::vector<double>& values) {
  const size_t stride = 1 + values.size() / 500;
  std::vector<double> kept;
  for (size_t i = 0; i < values.size(); i += stride) kept.push_back(values[i]);
  return kept;
}

}  // namespace foldproof
