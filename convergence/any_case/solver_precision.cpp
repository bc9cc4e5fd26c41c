#include "convergence/any_case/solver_precision.h"

#include <algorithm>
#include <cmath>

namespace foldproof {

namespace {

constexpr int most_doublings = 12;  // of steps a frame, beyond the first that was tried

double distance(const SolverPlan& plan, const LevelRun& a, const LevelRun& b) {
  return frame_distance(a.x, b.x, plan.mass);
}

MethodCurve curve_of(const SolverPlan& plan, const TrialLevels& runs) {
  MethodCurve curve{{plan.name, {}}, ladder_bar(runs, plan.mass, plan.formal_order, plan.floor)};
  const auto whole = fine_end(runs);
  const double frames = plan.end / plan.frame;
  for (const auto& [parts, run] : runs) {
    double error = nan;
    if (is_whole(run) && !whole.empty() && curve.bar.reading != Reading::inconclusive)
      error = (distance(plan, run, *whole.back().second) + curve.bar.half_width) / plan.motion;
    curve.runs.push_back({int(std::lround(parts * frames)),
                          error,
                          parts * frames,
                          run.seconds,
                          1,
                          {},
                          parts,
                          run.stopped,
                          run.clock});
  }
  return curve;
}

/// Where rounding hides what a further halving changes.
bool is_rounding(const SolverPlan& plan, const TrialLevels& runs) {
  const auto whole = fine_end(runs);
  if (whole.size() < 2) return false;
  const auto last = whole.end() - 1, before = whole.end() - 2;
  return distance(plan, *before->second, *last->second) <= floors_for_order * plan.floor;
}

bool is_exact_enough(const SolverPlan& plan, const TrialLevels& runs) {
  if (fine_end(runs).size() < 3) return false;
  if (is_rounding(plan, runs)) return true;
  const ErrorBar bar = ladder_bar(runs, plan.mass, plan.formal_order, plan.floor);
  return bar.reading != Reading::inconclusive &&
         bar.half_width / plan.motion <= truth_part * plan.wanted.back();
}

/// Whether to try a step twice as long: the longest so far reaches the largest wanted error, or an
/// error bar still lacks one of its three runs.
bool needs_longer_step(const SolverPlan& plan, const TrialLevels& runs) {
  const auto& [parts, run] = *runs.begin();
  if (!is_whole(run) || parts % 2 != 0) return false;
  const auto whole = fine_end(runs);
  return whole.size() < 3 ||
         distance(plan, run, *whole.back().second) / plan.motion <= plan.wanted.front();
}

bool is_unstable(const PrecisionRun& run) { return !(run.error <= diverged_error); }

/// Steps a frame between a step that reaches a wanted error and the next longer one, which is
/// unstable; 0: all such steps are close.
int between_unstable(const SolverPlan& plan, const TrialLevels& runs) {
  const MethodCurve curve = curve_of(plan, runs);
  for (const double wanted : plan.wanted) {
    const size_t first = first_exact(curve, wanted);
    if (first == 0 || first == curve.runs.size() || !is_unstable(curve.runs[first - 1])) continue;
    const int few = curve.runs[first - 1].parts, many = curve.runs[first].parts;
    if (many > narrow * few && many - few > 1) return (few + many) / 2;
  }
  return 0;
}

SolverPrice price_of(const SolverPlan& plan, const MethodCurve& curve, double wanted) {
  SolverPrice price{wanted, price_at(curve, plan.end, wanted)};
  if (!(plan.motion > 0))
    price.because = "how far the reference moves is not known";
  else if (curve.bar.reading == Reading::inconclusive)
    price.because = "its halved steps show no order: " + curve.bar.reason;
  else if (price.price.limit == LimitedBy::not_reached)
    price.because = "no step that was tried reaches it; a shorter one would take too long";
  else if (price.price.limit == LimitedBy::stability)
    price.unstable_step = plan.frame / curve.runs[first_exact(curve, wanted) - 1].parts;
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

int next_parts(const SolverPlan& plan, const TrialLevels& runs) {
  if (runs.empty()) return plan.first;
  const int parts = finest(runs).first;
  const LevelRun& run = runs.at(parts);
  const bool may_halve = parts < plan.first << most_doublings &&
                         (!is_whole(run) || 2 * run.clock <= plan.most_seconds);
  if (may_halve && !is_exact_enough(plan, runs)) return 2 * parts;
  if (needs_longer_step(plan, runs)) return runs.begin()->first / 2;
  return between_unstable(plan, runs);
}

bool SolverPrecision::is_answered() const {
  return std::ranges::all_of(prices,
                             [](const SolverPrice& p) { return std::isfinite(p.price.step); });
}

SolverPrecision solver_precision(const SolverPlan& plan, const TrialLevels& runs,
                                 const CaseTruth& truth, const std::vector<double>& times) {
  SolverPrecision answer{plan, curve_of(plan, runs), {}};
  for (const double wanted : plan.wanted)
    answer.prices.push_back(price_of(plan, answer.curve, wanted));
  const auto whole = fine_end(runs);
  if (whole.empty() || truth.first.x.empty()) return answer;
  const std::vector<PerParticle3> x = frames_at(*whole.back().second, times);
  if (x.size() != truth.first.x.size()) return answer;
  answer.from_truth = largest_difference(x, truth.first.x, plan.mass);
  const ErrorBar& bar = answer.curve.bar;
  if (bar.reading != Reading::inconclusive)
    answer.explained = bar.half_width + truth.uncertainty * truth.motion;
  return answer;
}

}  // namespace foldproof
