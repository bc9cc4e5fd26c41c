#include "convergence/any_case/solver_precision.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "convergence/any_case/distances.h"
#include "convergence/any_case/trial_ladder.h"

namespace foldproof {

namespace {

constexpr int most_doublings = 12;  // of steps a frame, beyond the first that was tried

bool came_to_end(const LevelRun& run) { return run.stopped.empty() && !run.x.empty(); }

double distance(const SolverPlan& plan, const LevelRun& a, const LevelRun& b) {
  return frame_distance(a.x, b.x, plan.mass);
}

/// Whole runs at the fine end of the ladder, coarse to fine; each has twice the steps of
/// the one before.
std::vector<std::pair<int, const LevelRun*>> whole_runs(const SolverRuns& runs) {
  std::vector<std::pair<int, const LevelRun*>> whole;
  for (auto run = runs.rbegin(); run != runs.rend(); ++run) {
    if (!is_halving(run->first)) continue;
    if (!came_to_end(run->second)) break;
    whole.emplace_back(run->first, &run->second);
  }
  std::ranges::reverse(whole);
  return whole;
}

ErrorBar bar_of(const SolverPlan& plan, const SolverRuns& runs) {
  std::vector<const std::vector<PerParticle3>*> frames;
  for (const auto& [parts, run] : whole_runs(runs)) frames.push_back(&run->x);
  return halved_steps_bar(frames, plan.mass, plan.formal_order, plan.floor);
}

std::vector<SolverStep> steps_of(const SolverPlan& plan, const SolverRuns& runs,
                                 const ErrorBar& bar) {
  const auto whole = whole_runs(runs);
  std::vector<SolverStep> steps;
  for (const auto& [parts, run] : runs) {
    SolverStep step{parts, plan.frame / parts, nan, {run.seconds, run.clock}, run.stopped};
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

/// Whether to try a step twice as long: the longest so far reaches the largest wanted error, or an
/// error bar still lacks one of its three runs.
bool needs_longer_step(const SolverPlan& plan, const SolverRuns& runs) {
  const auto& [parts, run] = *runs.begin();
  if (!came_to_end(run) || parts % 2 != 0) return false;
  const auto whole = whole_runs(runs);
  return whole.size() < 3 ||
         distance(plan, run, *whole.back().second) / plan.motion <= plan.wanted.front();
}

/// The first step from which on all errors are small enough; their number if there is none.
size_t first_exact(const std::vector<SolverStep>& steps, double wanted) {
  size_t first = steps.size();
  while (first > 0 && steps[first - 1].error <= wanted) --first;
  return first;
}

bool is_unstable(const SolverStep& step) { return !(step.error <= diverged_error); }

/// Steps a frame between a step that reaches a wanted error and the next longer one, which is
/// unstable; 0: all such steps are close.
int between_unstable(const SolverPlan& plan, const SolverRuns& runs) {
  const std::vector<SolverStep> steps = steps_of(plan, runs, bar_of(plan, runs));
  for (const double wanted : plan.wanted) {
    const size_t first = first_exact(steps, wanted);
    if (first == 0 || first == steps.size() || !is_unstable(steps[first - 1])) continue;
    const int few = steps[first - 1].parts, many = steps[first].parts;
    if (many > narrow * few && many - few > 1) return (few + many) / 2;
  }
  return 0;
}

SolverPrice price_of(const SolverPlan& plan, const ErrorBar& bar,
                     const std::vector<SolverStep>& steps, double wanted) {
  SolverPrice price{wanted};
  const size_t first = first_exact(steps, wanted);
  if (!(plan.motion > 0)) {
    price.because = "how far the reference moves is not known";
  } else if (bar.reading == Reading::inconclusive) {
    price.because = "its halved steps show no order: " + bar.reason;
  } else if (first == steps.size()) {
    price.because = "no step that was tried reaches it; a shorter one would take too long";
  } else {
    const SolverStep& fine = steps[first];
    price.step = fine.step, price.spent = fine.spent;
    price.is_whole_frame = first == 0;
    const SolverStep* coarse = first > 0 ? &steps[first - 1] : nullptr;
    if (coarse && is_unstable(*coarse)) price.unstable_step = coarse->step;
    if (coarse && !is_unstable(*coarse)) {
      const double part = std::log(wanted / fine.error) / std::log(coarse->error / fine.error);
      price.step *= std::pow(coarse->step / fine.step, part);
      price.spent.processor *= std::pow(coarse->spent.processor / fine.spent.processor, part);
      price.spent.clock *= std::pow(coarse->spent.clock / fine.spent.clock, part);
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
  auto finest = runs.rbegin();
  while (!is_halving(finest->first)) ++finest;
  const auto& [parts, run] = *finest;
  const bool may_halve = parts < plan.first << most_doublings &&
                         (!came_to_end(run) || 2 * run.clock <= plan.most_seconds);
  if (may_halve && !is_exact_enough(plan, runs)) return 2 * parts;
  if (needs_longer_step(plan, runs)) return runs.begin()->first / 2;
  return between_unstable(plan, runs);
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
