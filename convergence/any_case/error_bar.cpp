#include "convergence/any_case/error_bar.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reference/types.h"
#include "verification/evidence.h"

namespace foldproof {

namespace {

constexpr double safety_in_range = 1.25, safety_outside = 3;

/// Outside the asymptotic range no higher order is trusted [1].
constexpr double order_outside = 1;

std::vector<double> neighbouring_differences(const std::vector<double>& values) {
  std::vector<double> differences;
  for (size_t k = 0; k + 1 < values.size(); ++k) differences.push_back(values[k + 1] - values[k]);
  return differences;
}

/// Whether an order can be read from this difference.
bool stands_out(double difference, double floor) {
  return std::abs(difference) > floors_for_order * floor;
}

/// log(a/b) / log ratio, or NaN where a and b differ in sign or do not stand out.
double pair_order(double a, double b, const Ladder& ladder) {
  if (!(a * b > 0) || !stands_out(a, ladder.floor) || !stands_out(b, ladder.floor)) return nan;
  return std::log(a / b) / std::log(ladder.ratio);
}

void require_valid(const Ladder& ladder, const std::vector<double>& differences) {
  if (differences.size() < 2)
    throw InputError("an error bar needs three levels of refinement or more");
  if (!ladder.values.empty() && ladder.values.size() != differences.size() + 1)
    throw InputError("an error bar needs one difference less than values");
  if (!(ladder.ratio > 1)) throw InputError("an error bar needs a ratio of refinement > 1");
  if (!(ladder.formal_order > 0)) throw InputError("an error bar needs a formal order > 0");
}

/// Why the last differences have no order, in words; "" if they have one.
std::string why_no_order(const std::vector<double>& d, const std::vector<double>& orders,
                         double floor) {
  const double last = d.back(), before = d[d.size() - 2];
  if (!std::isfinite(last) || !std::isfinite(before)) return "a level came to no end";
  if (!stands_out(last, floor) || !stands_out(before, floor))
    return "differences between levels have sunk to rounding or the solver's tolerance";
  if (last * before < 0) return "differences between levels change sign";
  if (!(orders.back() > 0)) return "differences between levels grow";
  if (!(orders.back() >= least_order)) return "differences between levels hardly fall";
  return "";
}

void accept(ErrorBar& bar) {
  bar.reading = Reading::asymptotic;
  bar.reason.clear();
  bar.may_settle = false;
}

/// Reads the orders of a ladder that has a last one: asymptotic, or not yet, or at another order.
void read_orders(double formal, ErrorBar& bar) {
  const std::vector<double>& orders = bar.orders;
  const double last = orders.back(), off = std::abs(last - formal);
  bar.reading = Reading::not_asymptotic;
  bar.may_settle = true;
  if (orders.size() == 1) {
    bar.reason = "three levels give one order, and it is not the method's own";
    if (off <= same_order) accept(bar);
    return;
  }
  const double before = orders[orders.size() - 2], off_before = std::abs(before - formal);
  const bool is_steady = std::abs(last - before) <= same_order;
  const bool is_closing_in =
      off <= same_order && off < off_before && off_before <= far_below_formal;
  if (!is_steady && !is_closing_in) {
    bar.reason = "the order still changes from level to level";
  } else if (formal - last > far_below_formal) {
    bar.reason = fmt::format("settled at order {:.2g}, not at the formal {:g}", last, formal);
    bar.may_settle = false;
  } else {
    accept(bar);
  }
}

/// The bar of a ladder that has an order. A difference smaller than the highest order that is
/// trusted allows after the one before is an accident of signs; an order that falls may fall again.
double bar_with_order(const ErrorBar& bar, const Ladder& ladder, double last, double before) {
  const double highest = bar.reading == Reading::asymptotic
                             ? ladder.formal_order
                             : std::min(ladder.formal_order, order_outside);
  double order = std::min(bar.order, highest);
  if (bar.orders.size() > 1 && bar.order < bar.orders[bar.orders.size() - 2])
    order =
        std::min(order, std::max(2 * bar.order - bar.orders[bar.orders.size() - 2], least_order));
  const double difference =
      std::max(std::abs(last), std::abs(before) / std::pow(ladder.ratio, highest));
  return std::max(bar.safety * difference / (std::pow(ladder.ratio, order) - 1), ladder.floor);
}

/// Three times the largest of the last two differences; NaN if one is.
double spread(double last, double before, double floor) {
  if (std::isnan(last) || std::isnan(before)) return nan;
  return std::max(safety_outside * std::max(std::abs(last), std::abs(before)), floor);
}

}  // namespace

std::string_view name_of(Reading reading) {
  constexpr std::string_view names[] = {"asymptotic", "not asymptotic", "inconclusive"};
  return names[size_t(reading)];
}

std::string in_words(const ErrorBar& bar) {
  return std::string(name_of(bar.reading)) + (bar.reason.empty() ? "" : ": ") + bar.reason;
}

double asymptotic_order(const ErrorBar& bar) {
  return bar.reading == Reading::asymptotic ? bar.order : nan;
}

ErrorBar error_bar(const Ladder& ladder) {
  const std::vector<double> d =
      ladder.differences.empty() ? neighbouring_differences(ladder.values) : ladder.differences;
  require_valid(ladder, d);
  ErrorBar bar;
  for (size_t k = 0; k + 1 < d.size(); ++k)
    bar.orders.push_back(pair_order(d[k], d[k + 1], ladder));
  const double last = d.back(), before = d[d.size() - 2];
  bar.reason = why_no_order(d, bar.orders, ladder.floor);
  if (!bar.reason.empty()) {
    bar.half_width = spread(last, before, ladder.floor);
    return bar;
  }
  read_orders(ladder.formal_order, bar);
  bar.order = bar.orders.back();
  bar.safety = bar.reason.empty() ? safety_in_range : safety_outside;
  bar.half_width = bar_with_order(bar, ladder, last, before);
  if (!ladder.values.empty())
    bar.limit = ladder.values.back() +
                last / (std::pow(ladder.ratio, std::min(bar.order, ladder.formal_order)) - 1);
  return bar;
}

}  // namespace foldproof
