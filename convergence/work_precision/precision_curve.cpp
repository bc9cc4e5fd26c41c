#include "convergence/work_precision/precision_curve.h"

#include <cmath>

namespace foldproof {

namespace {

constexpr double same_step = 1e-9;  // steps that differ by less are the same one [1]

double log_between(double from, double to, double part) {
  return std::exp((1 - part) * std::log(from) + part * std::log(to));
}

Price price_of_run(const PrecisionRun& run, double end, LimitedBy limit) {
  return {
      limit,    end / run.steps, run.applications, run.seconds, double(run.work.unfinished_solves),
      run.clock};
}

/// The price between the first run that reaches the error and the one before it.
Price price_between(const PrecisionCurve& curve, size_t first, double end, double wanted) {
  const PrecisionRun& fine = curve.runs[first];
  if (first == 0) return price_of_run(fine, end, LimitedBy::not_tried);
  const PrecisionRun& coarse = curve.runs[first - 1];
  Price price = price_of_run(fine, end, LimitedBy::stability);
  if (!(coarse.error <= diverged_error)) return price;
  const double part = std::log(coarse.error / wanted) / std::log(coarse.error / fine.error);
  return {LimitedBy::accuracy,
          log_between(end / coarse.steps, price.step, part),
          log_between(coarse.applications, fine.applications, part),
          log_between(coarse.seconds, fine.seconds, part),
          price.unfinished,
          log_between(coarse.clock, fine.clock, part)};
}

}  // namespace

double energy_gain(const LongerRun& run) {
  const double energy = run.with_step.added,
               allowed = run.with_half.added + small_energy * run.with_half.largest;
  if (!std::isfinite(energy) || !std::isfinite(allowed)) return INFINITY;
  return energy == 0 ? 0 : energy / allowed;
}

bool lasts(const LongerRun& run) { return energy_gain(run) <= most_energy_gain; }

double shortest_unstable_step(const std::vector<LongerRun>& runs) {
  double shortest = INFINITY;
  for (const LongerRun& run : runs)
    if (!lasts(run)) shortest = std::min(shortest, run.step);
  return shortest;
}

const LongerRun* longer_run_of(const std::vector<LongerRun>& runs, double step) {
  for (const LongerRun& run : runs)
    if (std::abs(run.step / step - 1) <= same_step) return &run;
  return nullptr;
}

Mark mark_of(const PrecisionRun& run) {
  if (std::isnan(run.error)) return Mark::diverged;
  return run.work.unfinished_solves > 0 ? Mark::unfinished : Mark::measured;
}

size_t first_exact(const PrecisionCurve& curve, double wanted) {
  size_t first = curve.runs.size();
  while (first > 0 && curve.runs[first - 1].error <= wanted) --first;
  return first;
}

std::string_view name_of(LimitedBy limit) {
  constexpr std::string_view names[] = {"accuracy", "stability", "stability of longer runs",
                                        "longer steps not tried", "not reached in range"};
  return names[size_t(limit)];
}

Price price_at(const PrecisionCurve& curve, double end, double wanted) {
  const std::vector<PrecisionRun>& runs = curve.runs;
  size_t first = first_exact(curve, wanted);
  if (first == runs.size()) return {};
  const double unstable = shortest_unstable_step(curve.longer);
  const Price price = price_between(curve, first, end, wanted);
  if (price.step < unstable) return price;
  while (first < runs.size() && !(end / runs[first].steps < unstable * (1 - 1e-9))) ++first;
  return first == runs.size() ? Price{} : price_of_run(runs[first], end, LimitedBy::longer_run);
}

std::vector<CostAxis> cost_axes() {
  const auto of_step = [](const PrecisionRun& run, double end) { return end / run.steps; };
  return {{"work",
           "work",
           {"applications of force operators", "1", Scale::log},
           [](const PrecisionRun& run, double) { return run.applications / run.part; }},
          {"time",
           "time",
           {"processor time", "s", Scale::log},
           [](const PrecisionRun& run, double) { return run.seconds / run.part; }},
          {"step", "step", {"step", "s", Scale::log}, of_step}};
}

Curve error_curve(const PrecisionCurve& curve, const CostAxis& cost, double end, double floor) {
  constexpr double percent = 100;
  Curve points{curve.method, {}, {}, percent * floor, {}};
  for (const PrecisionRun& run : curve.runs) {
    points.point(cost.of(run, end) / cost.unit, percent * run.error);
    points.marks.push_back(mark_of(run));
  }
  return points;
}

}  // namespace foldproof
