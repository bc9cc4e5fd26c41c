// Prices of wanted errors, from curves of error against cost.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "convergence/any_case/precision.h"

namespace foldproof {

namespace {

/// Work of the run that reaches the error over that of the next coarser one, which does not; 1
/// if there is none.
double spacing_at(const PrecisionCurve& curve, double wanted) {
  const std::vector<PrecisionRun>& runs = curve.runs;
  size_t first = runs.size();
  while (first > 0 && runs[first - 1].error <= wanted) --first;
  if (first == 0 || first == runs.size()) return 1;
  return double(runs[first].steps) / runs[first - 1].steps;
}

std::string why_not_reached(const MethodCurve& curve) {
  for (size_t k = curve.stopped.size(); k-- > 0;)
    if (const double error = curve.curve.runs[k].error; !std::isnan(error))
      return fmt::format(
          "with {} steps a frame its error is {:.2g} %; less would need more work than the budget, "
          "or {:.0f} times the cheapest method's",
          curve.parts[k], 100 * error, dearest);
  if (curve.stopped.empty()) return "its work exceeds the budget at every step";
  const std::string& last = curve.stopped.back();
  return last.empty() ? "it is unstable at every step that was tried"
                      : "no run comes to its end: " + last;
}

MethodPrice price_of_method(const MethodCurve& curve, const PrecisionPlan& plan, double wanted) {
  MethodPrice price{curve.method, price_at(curve.curve, plan.input_case.scene.schedule.end, wanted),
                    spacing_at(curve.curve, wanted)};
  if (price.price.limit == LimitedBy::not_reached) price.because = why_not_reached(curve);
  return price;
}

PriceList price_list(const PrecisionAnswer& answer, double wanted) {
  PriceList list{wanted, {}};
  const bool is_known = wanted >= least_error(answer.truth);
  for (const MethodCurve& curve : answer.curves) {
    if (!std::ranges::count(answer.plan.methods, curve.method)) continue;
    MethodPrice price = price_of_method(curve, answer.plan, wanted);
    if (!is_known) {
      price.price = {LimitedBy::not_reached, nan, nan, nan, nan};
      price.because = "the truth is not known to a tenth of this error";
    }
    list.prices.push_back(price);
  }
  const auto cost = [](const MethodPrice& price) {
    return std::isnan(price.price.applications) ? INFINITY : price.price.applications;
  };
  std::ranges::stable_sort(list.prices, {}, cost);
  const MethodPrice best = list.prices.front();
  for (MethodPrice& price : list.prices) {
    price.over_best = price.price.applications / best.price.applications;
    price.is_tied =
        price.method != best.method && price.over_best <= std::max(price.spacing, best.spacing);
  }
  return list;
}

}  // namespace

PrecisionAnswer precision_answer(const PrecisionPlan& plan, const TrialRuns& runs) {
  PrecisionAnswer answer{plan, case_truth(plan, runs), {}, {}};
  answer.curves = method_curves(plan, runs, answer.truth);
  for (const double wanted : plan.wanted) answer.lists.push_back(price_list(answer, wanted));
  return answer;
}

}  // namespace foldproof
