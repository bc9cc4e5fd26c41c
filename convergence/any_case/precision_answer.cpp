// Prices of wanted errors, from curves of error against cost.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "convergence/any_case/precision.h"
#include "convergence/any_case/trial_ladder.h"

namespace foldproof {

namespace {

std::string why_not_reached(const PrecisionPlan& plan, const MethodCurve& curve, double wanted) {
  if (!curve.curve.runs.empty() && curve.curve.runs.back().error <= wanted)
    return fmt::format("no step that was tried is stable in a run until {:.3g} s",
                       lasting_end(plan));
  for (size_t k = curve.stopped.size(); k-- > 0;)
    if (const double error = curve.curve.runs[k].error; !std::isnan(error))
      return fmt::format(
          "with {} steps a frame its error is {:.2g} %; less would need more work than the budget, "
          "or {:.0f} times the cheapest method's",
          curve.parts[k], 100 * error, dearest);
  if (curve.stopped.empty()) return "its work exceeds the budget at every step";
  const std::string& last = curve.stopped.back();
  return last.empty() ? "it is unstable at every step that was tried"
                      : "every run stops early: " + last;
}

MethodPrice price_of_error(const MethodCurve& curve, const PrecisionPlan& plan, double wanted) {
  const Bracket bracket = bracket_of(plan, curve, wanted);
  MethodPrice price{curve.method, price_at(curve.curve, plan.input_case.scene.schedule.end, wanted),
                    bracket.few == 0 ? 1 : double(bracket.many) / bracket.few};
  if (!std::isnan(price.price.step))
    price.whole_step = frame_of(plan) / parts_of(plan, price.price.step);
  if (const LongerRun* run = longer_run_of(curve.curve.longer, price.whole_step))
    price.energy_gain = energy_gain(*run);
  if (price.price.limit == LimitedBy::not_reached)
    price.because = why_not_reached(plan, curve, wanted);
  return price;
}

/// The price of the wanted error, or of a smaller one whose run turned out cheaper: what reaches
/// that reaches this.
MethodPrice price_of_method(const MethodCurve& curve, const PrecisionPlan& plan, double wanted,
                            double least) {
  MethodPrice best = price_of_error(curve, plan, wanted);
  for (const double smaller : plan.wanted) {
    if (!(smaller < wanted) || smaller < least) continue;
    const MethodPrice other = price_of_error(curve, plan, smaller);
    const bool is_reached = !std::isnan(other.price.applications);
    if (is_reached && !(best.price.applications <= other.price.applications)) best = other;
  }
  return best;
}

}  // namespace

PriceList price_list(const PrecisionPlan& plan, const CaseTruth& truth,
                     const std::vector<MethodCurve>& curves, double wanted) {
  PriceList list{wanted, {}};
  const bool is_known = wanted >= least_error(truth);
  for (const MethodCurve& curve : curves) {
    if (!std::ranges::count(plan.methods, curve.method)) continue;
    MethodPrice price = price_of_method(curve, plan, wanted, least_error(truth));
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

std::vector<const MethodPrice*> winners(const PriceList& list) {
  std::vector<const MethodPrice*> found;
  const MethodPrice* fastest = nullptr;
  for (const MethodPrice& price : list.prices) {
    if (std::isnan(price.price.applications)) continue;
    if (found.empty() || price.is_tied) found.push_back(&price);
    if (!fastest || price.price.seconds < fastest->price.seconds) fastest = &price;
  }
  if (fastest && !std::ranges::count(found, fastest)) found.push_back(fastest);
  return found;
}

PrecisionAnswer precision_answer(const PrecisionPlan& plan, const Trials& trials) {
  PrecisionAnswer answer{plan, case_truth(plan, trials.runs), {}, {}};
  answer.curves = method_curves(plan, trials, answer.truth);
  for (const double wanted : plan.wanted)
    answer.lists.push_back(price_list(plan, answer.truth, answer.curves, wanted));
  return answer;
}

}  // namespace foldproof
