// The answer of the search for the cheapest method, in words, figures and tables.
#include "convergence/any_case/precision.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "convergence/any_case/ladder_cost.h"

namespace foldproof {

namespace {

constexpr double percent = 100, milli = 1e-3;
constexpr double levels_wanted_over_first = 4;  // work of the third of three halved steps [1]

/// A step that is printed to be used: whether it lasts, and how far it is beyond the limit that the
/// automatic step keeps.
std::string step_in_words(const PrecisionPlan& plan, const MethodPrice& of) {
  const Price& price = of.price;
  const std::string step = fmt::format(
      "h {} {:.5g} ms", price.limit == LimitedBy::not_tried ? ">=" : "=", of.whole_step / milli);
  if (std::isnan(of.energy_gain))
    return fmt::format(
        "the automatic step ({} reaches the error, but to try it until {:.3g} s costs more than "
        "the budget)",
        step, lasting_end(plan));
  const double over_limit = of.whole_step / plan.limits.at(of.method);
  if (!(over_limit > 1)) return step;
  return step + fmt::format(" ({:.3g} times the limit of the automatic step)", over_limit);
}

/// Which method takes the fewest seconds, where it beats the first of the list by more than a tie:
/// filters of contact and strain cost time that is not counted as work; "" where it is.
std::string by_seconds(const PrecisionPlan& plan, const PriceList& list) {
  const MethodPrice& first = list.prices.front();
  const MethodPrice* fastest = &first;
  for (const MethodPrice& price : list.prices)
    if (price.price.seconds < fastest->price.seconds) fastest = &price;
  const double over_fastest = first.price.seconds / fastest->price.seconds;
  if (!(over_fastest > std::max(first.spacing, fastest->spacing))) return "";  // a tie
  return fmt::format("; by seconds {} with {}, 1.0; {} {:.3g}", fastest->method,
                     step_in_words(plan, *fastest), first.method, over_fastest);
}

std::string sentence_of(const PrecisionAnswer& answer, const PriceList& list) {
  const std::string head =
      fmt::format("{} at {:.3g} %: ", answer.plan.input_case.scene.name, percent * list.wanted);
  if (!(list.wanted >= least_error(answer.truth)))
    return head + "no price, since the truth is not known to a tenth of this error";
  std::vector<std::string> parts, ties, unreached;
  for (const MethodPrice& price : list.prices) {
    if (std::isnan(price.price.applications))
      unreached.push_back(price.method);
    else if (parts.empty())
      parts.push_back(
          fmt::format("{} with {}, 1.0", price.method, step_in_words(answer.plan, price)));
    else
      parts.push_back(fmt::format("{} {:.3g}{}", price.method, price.over_best,
                                  price.is_tied ? " (tied)" : ""));
  }
  std::string sentence = head + fmt::format("{}", fmt::join(parts, "; "));
  if (!unreached.empty())
    sentence += fmt::format("{}{} {} not reach it within the budget", parts.empty() ? "" : "; ",
                            fmt::join(unreached, ", "), unreached.size() == 1 ? "does" : "do");
  return sentence + by_seconds(answer.plan, list);
}

Figure figure_of(const PrecisionAnswer& answer, const CostAxis& cost) {
  const Scene& scene = answer.plan.input_case.scene;
  Figure figure{
      scene.name + "-" + cost.name,
      "Error against " + cost.name + ": " + scene.name,
      cost.axis,
      {"position error over the motion", "%", Scale::log},
      nan,
      "Root mean square over the free particles, in the worst frame, over the largest such "
      "distance from the start. In the strip at the top: runs that did not finish or err by more "
      "than the motion. The floor is the distance of the two opinions on the truth.",
      {}};
  for (const MethodCurve& curve : answer.curves)
    if (!curve.runs.empty())
      figure.curves.push_back(
          error_curve(curve, cost, scene.schedule.end, answer.truth.uncertainty));
  return figure;
}

Table price_table(const PrecisionAnswer& answer) {
  Table table(
      "error wanted [%]; method [1]; step [s]; step limited by [1]; operator applications [1]; "
      "over the cheapest [1]; tied with it [1]; processor time [s]; energy gain of a longer run "
      "[1]; why no price [1]");
  for (const PriceList& list : answer.lists)
    for (const MethodPrice& price : list.prices)
      table.row(percent * list.wanted, price.method, price.whole_step, name_of(price.price.limit),
                price.price.applications, price.over_best, price.is_tied ? "yes" : "no",
                price.price.seconds, price.energy_gain, price.because);
  return {"prices", "What a position error costs with each method, the cheapest by work first",
          table};
}

Table method_table(const PrecisionAnswer& answer) {
  Table table(
      "method [1]; order of the table [1]; order observed in the asymptotic range [1]; reading "
      "[1]; because [1]; largest stable step found [s]; next longer step, unstable [s]");
  for (const MethodCurve& curve : answer.curves)
    table.row(curve.method, integrator_named(curve.method).order, asymptotic_order(curve.bar),
              name_of(curve.bar.reading), curve.bar.reason, curve.stable_step, curve.unstable_step);
  return {"methods", "Order and largest stable step of each method on this case", table};
}

/// Every step that was asked whether it lasts.
Table longer_run_table(const PrecisionAnswer& answer) {
  Table table(
      "method [1]; step [s]; largest kinetic energy of the added time [J]; with half the step [J]; "
      "at any time [J]; energy gain [1]; lasts [1]");
  for (const MethodCurve& curve : answer.curves)
    for (const LongerRun& run : curve.longer)
      table.row(curve.method, run.step, run.with_step.added, run.with_half.added,
                run.with_half.largest, energy_gain(run), lasts(run) ? "yes" : "no");
  return {
      "longer-runs",
      fmt::format(
          "Every step that was tried in a run until {:.3g} s; those that do not last get no price. "
          "The gain is the energy over that with half the step; no energy: the run came to no end",
          lasting_end(answer.plan)),
      table};
}

Table run_table(const PrecisionAnswer& answer) {
  Table table(
      "method [1]; steps a frame [1]; steps [1]; error [%]; operator applications [1]; processor "
      "time [s]; unfinished solves [1]; stopped [1]");
  for (const MethodCurve& curve : answer.curves)
    for (const PrecisionRun& run : curve.runs)
      table.row(curve.method, run.parts, run.steps, percent * run.error, run.applications,
                run.seconds, run.work.unfinished_solves, run.stopped);
  return {"runs", "Every run; no error where it came to no end", table};
}

bool has_price(const PrecisionAnswer& answer) {
  return std::ranges::any_of(answer.lists,
                             [](const PriceList& list) { return is_priced(list.prices.front()); });
}

/// To so many digits, up or down.
double rounded(double number, int digits, double (*to)(double)) {
  const double unit = std::pow(10, std::floor(std::log10(number)) + 1 - digits);
  return to(number / unit) * unit;
}

}  // namespace

std::vector<std::string> precision_sentences(const PrecisionAnswer& answer) {
  std::vector<std::string> sentences;
  for (const PriceList& list : answer.lists) sentences.push_back(sentence_of(answer, list));
  return sentences;
}

std::string for_truth_in_words(const PrecisionAnswer& answer) {
  const std::vector<std::string>& methods = answer.plan.for_truth;
  if (methods.empty()) return "";
  const bool is_one = methods.size() == 1;
  return fmt::format(
      "{} {} not requested: {} only to find the truth, for which methods of all families run, and "
      "{} no price",
      fmt::join(methods, " and "), is_one ? "was" : "were", is_one ? "it serves" : "they serve",
      is_one ? "gets" : "get");
}

std::string advice_in_words(const PrecisionAnswer& answer) {
  const EndedRun& run = answer.furthest;
  const double least = least_error(answer.truth), largest = answer.plan.wanted.front();
  if (has_price(answer)) return "";
  if (least > largest && least < 1)
    return fmt::format(
        "the two best runs differ too much for such errors; for {:.2g} % and more try --errors "
        "{:g}",
        percent * least, rounded(least, 1, std::ceil));
  if (run.parts == 0) return "";
  const double more = levels_wanted_over_first / std::max(run.part, 1e-3);
  const double end = answer.plan.input_case.scene.schedule.end;
  return fmt::format(
      "the budget ended the runs: {} with {} steps a frame came furthest, to {:.2g} s of {:.3g} s; "
      "for three halved steps try --until {:g}, or more than {:.2g} times the --effort, {} a "
      "method",
      run.method, run.parts, run.part * end, end, rounded(end / more, 2, std::floor), more,
      duration_text(run.seconds * more));
}

std::string truth_in_words(const PrecisionAnswer& answer) {
  const CaseTruth& truth = answer.truth;
  if (std::isnan(truth.uncertainty) && std::isfinite(truth.motion) && truth.second.parts == 0)
    return fmt::format(
        "truth: unknown; nothing moves ({:.1g} m), or only one method knows how it moves",
        truth.motion);
  if (std::isnan(truth.uncertainty))
    return "truth: unknown; no method came to an end with two steps";
  const auto words = [](const Opinion& opinion) {
    return fmt::format("{} with {} steps a frame{}", opinion.method, opinion.parts,
                       opinion.is_extrapolated ? ", extrapolated" : "");
  };
  return fmt::format(
      "truth: {}; {} differs by {:.2g} % of the motion ({:.3g} m), good for errors down to {:.2g} "
      "%",
      words(truth.first), words(truth.second), percent * truth.uncertainty, truth.motion,
      percent * least_error(truth));
}

StudyRecord precision_record(const PrecisionAnswer& answer, double seconds) {
  const std::string name = answer.plan.input_case.scene.name;
  StudyRecord record{"precision." + name, "", "", "", seconds, {}, {}, {}};
  record.claim = fmt::format("{}.", fmt::join(precision_sentences(answer), ". "));
  record.about =
      "Which integrator is cheapest for this case at a wanted error? Every method runs it with "
      "constant steps, halved from run to run. Work is counted in applications of force operators; "
      "contact and strain limits are not among them; seconds include them. Prices are interpolated "
      "in logarithms between the two runs that bracket the error, never beyond them. The steps of "
      "the cheapest methods are tried again in a longer run, at least three times as long and at "
      "least to the end of the case. One that does not last there gets no price, and a shorter one "
      "is tried in its place: see the table of longer runs. A step lasts if the kinetic energy of "
      "the added time is at most twice that with half the step. The " +
      truth_in_words(answer) + ".";
  for (const CostAxis& cost : cost_axes()) record.figures.push_back(figure_of(answer, cost));
  if (const std::string why = for_truth_in_words(answer); !why.empty()) {
    record.about += " " + why + ".";
    for (Figure& figure : record.figures) figure.caption += " " + why + ".";
  }
  record.tables = {price_table(answer), method_table(answer), longer_run_table(answer),
                   run_table(answer)};
  return record;
}

}  // namespace foldproof
