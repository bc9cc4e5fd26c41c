#include "verification/oracles/folds.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "reference/types.h"
#include "verification/oracles/gsl.h"

namespace foldproof::oracles {

namespace {

/// The highest value of a parabola through three values at neighbouring places.
double top_of_parabola(double before, double top, double after) {
  const double slope = (after - before) / 2, bend = before - 2 * top + after;
  return bend == 0 ? top : top - slope * slope / (2 * bend);
}

Estimate highest(const StripShape& shape) {
  const auto is_lower = [](const StripPoint& a, const StripPoint& b) { return a.up < b.up; };
  const auto top = std::max_element(shape.points.begin() + 1, shape.points.end() - 1, is_lower);
  return {top_of_parabola((top - 1)->up, top->up, (top + 1)->up), shape.uncertainty};
}

}  // namespace

HeavyStrip lifted_part(const HeavyStrip& strip, double lift_off) {
  const double share = 1 - lift_off;
  HeavyStrip part = strip;
  part.gamma *= share * share * share;
  part.last->across = (part.last->across - lift_off) / share;
  part.last->up /= share;
  return part;
}

Fold fold_on_floor(const HeavyStrip& strip, double least, double most, const StripSolver& solver) {
  if (!strip.last || strip.first_slope != 0)
    throw InputError(
        "oracle folds: the strip must lie level at its first end, and have its last held");
  const std::vector<double> ends{1};
  const auto curvature = [&](double lift_off) {
    return solver(lifted_part(strip, lift_off), ends).first_curvature;
  };
  constexpr double width = 1e-10;
  Fold fold{bracketed_root(curvature, least, most, width), {}};
  std::vector<double> even;
  for (int i = 0; i <= 2000; ++i) even.push_back(i / 2000.0);
  const double share = 1 - fold.lift_off.value;
  const Estimate top = highest(solver(lifted_part(strip, fold.lift_off.value), even));
  // a lift-off that is off moves the top by no more than a few times as much; the parabola errs by
  // the fourth power of the points' distance
  fold.lift_off.uncertainty += top.uncertainty;
  fold.height = {share * top.value, top.uncertainty + 4 * fold.lift_off.uncertainty + 1e-12};
  return fold;
}

}  // namespace foldproof::oracles
