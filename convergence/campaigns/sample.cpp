#include "convergence/campaigns/sample.h"

#include <fmt/format.h>

#include <cmath>
#include <numeric>
#include <random>
#include <utility>

namespace foldproof {

namespace {

/// A number in [0, 1), of the generator's 53 upper bits: the standard's distributions differ
/// between libraries.
double uniform(std::mt19937_64& random) { return double(random() >> 11) * 0x1p-53; }

double value_at(const KeyTable& distribution, double u) {
  if (!distribution.has("mean")) return spread_over(distribution, u);
  const double deviation = distribution.number("deviation");
  if (!(deviation > 0))
    throw InputError(distribution.where("deviation") + ": 'deviation' must be > 0");
  return distribution.number("mean") + deviation * normal_quantile(u);
}

}  // namespace

double spread_over(const KeyTable& range, double u) {
  const double from = range.number("from"), to = range.number("to");
  const std::string spacing = range.text_or("spacing", "linear");
  if (spacing == "linear") return u < 1 ? from + u * (to - from) : to;
  if (spacing != "log")
    throw InputError(range.where("spacing") + ": 'spacing' is \"linear\" or \"log\"");
  if (!(from > 0 && to > 0))
    throw InputError(range.where("spacing") + ": a logarithmic range needs from > 0 and to > 0");
  return u < 1 ? from * std::pow(to / from, u) : to;
}

double normal_quantile(double u) {
  // Newton's method on Phi(x) = erfc(-x/sqrt 2)/2, from the side on which it converges
  double x = 0;
  for (int k = 0; k < 60; ++k) {
    const double density = std::exp(-x * x / 2) / std::sqrt(2 * 3.14159265358979323846);
    const double error = std::erfc(-x / std::sqrt(2.0)) / 2 - u;
    const double step = std::min(1.0, std::max(-1.0, error / density));
    x -= step;
    if (std::abs(step) < 1e-15 * (1 + std::abs(x))) break;
  }
  return x;
}

CampaignAxis latin_hypercube(const KeyTable& table) {
  const long count = table.integer("count");
  if (count < 1) throw InputError(table.where("count") + ": 'count' must be at least 1");
  std::mt19937_64 random(std::uint64_t(table.integer_or("seed", 1)));
  CampaignAxis axis;
  axis.is_sample = true;
  axis.rows.resize(size_t(count));
  for (const auto& [key, value] : table.entries) {
    if (key == "count" || key == "seed") continue;
    const auto distribution = table.table(key);
    std::vector<size_t> strata(axis.rows.size());
    std::iota(strata.begin(), strata.end(), size_t(0));
    for (size_t k = strata.size(); k > 1; --k) std::swap(strata[k - 1], strata[random() % k]);
    for (size_t r = 0; r < strata.size(); ++r) {
      // never 0, where a normal quantile has no value
      const double u = (double(strata[r]) + std::max(uniform(random), 0x1p-53)) / double(count);
      axis.rows[r].push_back(fmt::format("{}", value_at(*distribution, u)));
    }
    axis.keys.push_back(key);
  }
  if (axis.keys.empty()) throw InputError(table.where() + ": [sample] has no parameter");
  return axis;
}

}  // namespace foldproof
