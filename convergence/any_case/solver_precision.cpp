#include "convergence/any_case/solver_precision.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "convergence/any_case/distances.h"

namespace foldproof {

namespace {

constexpr int most_doublings = 10;  // of steps a frame, beyond the first that was tried

bool came_to_end(const LevelRun& run) { return run.stopped.empty() && !run.x.empty(); }

double distance(const SolverPlan& plan, const LevelRun& a, const LevelRun& b) {
  return a.x.size() == b.x.size() ? largest_difference(a.x, b.x, plan.mass) : nan;
}

/// Whole runs at the fine end, coarse to fine; each has twice the steps of the one before.
std::vector<std::pair<int, const LevelRun*>> whole_runs(const SolverRuns& runs) {
  std::vector<std::pair<int, const LevelRun*>> whole;
  for (auto run = runs.rbegin(); run != runs.rend() && came_to_end(run->second); ++run)
    whole.emplace_back(run->first, &run->second);
  std::ranges::reverse(whole);
  return whole;
}

ErrorBar bar_of(const SolverPlan& plan, const SolverRuns& runs) {
  const auto whole = whole_runs(runs);
  ErrorBar bar;
  if (whole.size() < 3) {
    bar.reason = "fewer than three halved steps came to an end";
    return bar;
  }
  Ladder ladder;
  for (size_t k = 0; k + 1 < whole.size(); ++k)
    ladder.differences.push_back(distance(plan, *whole[k].second, *whole[k + 1].second));
  ladder.formal_order = plan.formal_order;
  ladder.floor = plan.floor;
  return error_bar(ladder);
}

std::vector<SolverStep> steps_of(const SolverPlan& plan, const SolverRuns& runs,
                                 const ErrorBar& bar) {
  const auto whole = whole_runs(runs);
  std::vector<SolverStep> steps;
  for (const auto& [parts, run] : runs) {
    SolverStep step{parts, plan.frame / parts, nan, run.seconds, run.stopped};
    if (came_to_end(run) && !whole.empty() && bar.reading != Reading::inconclusive)
      step.error = (distance(plan, run, *whole.back().second) + bar.half_width) / plan.motion;
    steps.push_back(step);
  }
  return steps;
}

/// Where rounding hides what a further halving changes.
bool is_rounding(const SolverPlan& plan, const SolverRuns& runs) {
  const auto whole = whole_runs(runs);
  if (whole.size() < 2) return false;
  const auto last = whole.end() - 1, before = whole.end() - 2;
  return distance(plan, *before->second, *last->second) <= floors_for_order * plan.floor;
}

bool is_exact_enough(const SolverPlan& plan, const SolverRuns& runs) {
  if (whole_runs(runs).size() < 3) return false;
  if (is_rounding(plan, runs)) return true;
  const ErrorBar bar = bar_of(plan, runs);
  return bar.reading != Reading::inconclusive &&
         bar.half_width / plan.motion <= truth_part * plan.wanted.back();
}

bool needs_longer_step(const SolverPlan& plan, const SolverRuns& runs) {
  const auto& [parts, run] = *runs.begin();
  const auto whole = whole_runs(runs);
  return came_to_end(run) && parts % 2 == 0 && whole.size() > 1 &&
         distance(plan, run, *whole.back().second) / plan.motion <= plan.wanted.front();
}

SolverPrice price_of(const SolverPlan& plan, const ErrorBar& bar,
                     const std::vector<SolverStep>& steps, double wanted) {
  SolverPrice price{wanted};
  size_t first = steps.size();  // from which on all errors are small enough
  while (first > 0 && steps[first - 1].error <= wanted) --first;
  if (!(plan.motion > 0)) {
    price.because = "how far the reference moves is not known";
  } else if (bar.reading == Reading::inconclusive) {
    price.because = "its halved steps show no order: " + bar.reason;
  } else if (first == steps.size()) {
    price.because = "no step that was tried reaches it; a shorter one would take too long";
  } else {
    const SolverStep& fine = steps[first];
    price.step = fine.step, price.seconds = fine.seconds;
    price.is_longest_tried = first == 0;
    const SolverStep* coarse = first > 0 ? &steps[first - 1] : nullptr;
    if (coarse && coarse->error <= diverged_error) {
      const double part = std::log(wanted / fine.error) / std::log(coarse->error / fine.error);
      price.step *= std::pow(coarse->step / fine.step, part);
      price.seconds *= std::pow(coarse->seconds / fine.seconds, part);
    }
  }
  return price;
}

/// Of the frames at these times; empty where one is missing.
std::vector<PerParticle3> frames_at(const LevelRun& run, const std::vector<double>& times) {
  std::vector<PerParticle3> x;
  for (const double time : times) {
    const auto found = std::ranges::find_if(
        run.times, [&](double at) { return std::abs(at - time) <= 1e-9 * run.times.back(); });
    if (found == run.times.end()) return {};
    x.push_back(run.x[size_t(found - run.times.begin())]);
  }
  return x;
}

}  // namespace

int next_parts(const SolverPlan& plan, const SolverRuns& runs) {
  if (runs.empty()) return plan.first;
  const auto& [finest, run] = *runs.rbegin();
  const bool may_halve =
      finest < plan.first << most_doublings && 2 * run.seconds <= plan.most_seconds;
  if (may_halve && !is_exact_enough(plan, runs)) return 2 * finest;
  return needs_longer_step(plan, runs) ? runs.begin()->first / 2 : 0;
}

bool SolverPrecision::is_answered() const {
  return std::ranges::all_of(prices, [](const SolverPrice& p) { return std::isfinite(p.step); });
}

SolverPrecision solver_precision(const SolverPlan& plan, const SolverRuns& runs,
                                 const CaseTruth& truth, const std::vector<double>& times) {
  SolverPrecision answer{plan, bar_of(plan, runs), {}, {}};
  answer.steps = steps_of(plan, runs, answer.bar);
  for (const double wanted : plan.wanted)
    answer.prices.push_back(price_of(plan, answer.bar, answer.steps, wanted));
  const auto whole = whole_runs(runs);
  if (whole.empty() || truth.first.x.empty()) return answer;
  const std::vector<PerParticle3> x = frames_at(*whole.back().second, times);
  if (x.size() != truth.first.x.size()) return answer;
  answer.from_truth = largest_difference(x, truth.first.x, plan.mass);
  if (answer.bar.reading != Reading::inconclusive)
    answer.explained = answer.bar.half_width + truth.uncertainty * truth.motion;
  return answer;
}

}  // namespace foldproof
