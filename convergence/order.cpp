#include "convergence/order.h"

#include <cmath>
#include <limits>
#include <string>

#include "reference/types.h"

namespace foldproof {

namespace {

void require_valid(const Convergence& convergence) {
  const std::vector<double>& steps = convergence.steps;
  if (steps.size() != convergence.errors.size() || steps.size() < 2)
    throw InputError("convergence: " + std::to_string(steps.size()) + " steps and " +
                     std::to_string(convergence.errors.size()) +
                     " errors; give two or more of each");
  for (size_t i = 0; i < steps.size(); ++i)
    if (!(steps[i] > 0) || (i > 0 && !(steps[i] < steps[i - 1])))
      throw InputError("convergence: step " + std::to_string(i) +
                       " must be > 0 and smaller than the one before");
}

/// log e, NaN for errors that have no logarithm.
double log_of(double error) {
  return error > 0 ? std::log(error) : std::numeric_limits<double>::quiet_NaN();
}

/// How far log e can move when e may be off by `floor`; the side towards zero is the farther one.
double log_uncertainty(double error, double floor) {
  if (floor == 0) return 0;
  return floor < error ? -std::log1p(-floor / error) : std::numeric_limits<double>::infinity();
}

}  // namespace

std::vector<double> pair_orders(const Convergence& convergence) {
  require_valid(convergence);
  const auto& [steps, errors, floor] = convergence;
  std::vector<double> orders;
  for (size_t i = 0; i + 1 < steps.size(); ++i)
    orders.push_back((log_of(errors[i]) - log_of(errors[i + 1])) /
                     std::log(steps[i] / steps[i + 1]));
  return orders;
}

Convergence convergence_of(const Table& refined, std::string_view errors) {
  return {refined.numbers(refined.columns().front().name), refined.numbers(errors), 0};
}

std::vector<double> row_orders(const Convergence& convergence) {
  std::vector<double> orders = pair_orders(convergence);
  orders.insert(orders.begin(), nan);
  return orders;
}

Curve curve_of(const std::string& label, const Convergence& convergence) {
  const double floor = convergence.floor == 0 ? nan : convergence.floor;
  return {label, convergence.steps, convergence.errors, floor, pair_orders(convergence)};
}

double fitted_order(const Convergence& convergence) {
  require_valid(convergence);
  const auto& [steps, errors, floor] = convergence;
  double mean_x = 0, mean_y = 0;
  for (size_t i = 0; i < steps.size(); ++i) {
    mean_x += std::log(steps[i]) / double(steps.size());
    mean_y += log_of(errors[i]) / double(steps.size());
  }
  double xx = 0, xy = 0;
  for (size_t i = 0; i < steps.size(); ++i) {
    const double dx = std::log(steps[i]) - mean_x;
    xx += dx * dx;
    xy += dx * (log_of(errors[i]) - mean_y);
  }
  return xy / xx;
}

Estimate order_deviation(const Convergence& convergence, double expected, int pairs) {
  const std::vector<double> orders = pair_orders(convergence);
  if (!(pairs >= 1 && pairs <= int(orders.size())))
    throw InputError("convergence: " + std::to_string(pairs) + " pairs asked of " +
                     std::to_string(orders.size()));
  Worst deviation, uncertainty;
  for (size_t i = orders.size() - size_t(pairs); i < orders.size(); ++i) {
    deviation.observe(std::abs(orders[i] - expected));
    const double shift = log_uncertainty(convergence.errors[i], convergence.floor) +
                         log_uncertainty(convergence.errors[i + 1], convergence.floor);
    uncertainty.observe(shift / std::log(convergence.steps[i] / convergence.steps[i + 1]));
  }
  return {deviation.value(), uncertainty.value()};
}

Verdict order_verdict(const Convergence& convergence, double expected, int pairs, double bound,
                      std::string why_bound) {
  const Estimate deviation = order_deviation(convergence, expected, pairs);
  return {deviation.value, bound, deviation.uncertainty, "1", std::move(why_bound)};
}

Estimate richardson(double coarse, double fine, double ratio, double order) {
  if (!(ratio > 1)) throw InputError("richardson: the ratio of the steps must be > 1");
  if (!(order > 0)) throw InputError("richardson: the order must be > 0");
  const double correction = (fine - coarse) / (std::pow(ratio, order) - 1);
  return {fine + correction, std::abs(correction)};
}

int asymptotic_from(const std::vector<double>& orders, double expected, double within) {
  int first = int(orders.size());
  while (first > 0 && std::abs(orders[size_t(first) - 1] - expected) <= within) --first;
  return first;
}

int levels_above_floor(const Convergence& convergence, double factor) {
  require_valid(convergence);
  int levels = 0;
  for (double error : convergence.errors) {
    if (!(error > factor * convergence.floor)) break;
    ++levels;
  }
  return levels;
}

}  // namespace foldproof
