// Which step of another solver reaches a wanted error, and what does it cost? Its steps are halved;
// its error is the distance from its own limit, as `precision` measures the reference's methods.
#pragma once

#include <string>
#include <vector>

#include "convergence/any_case/precision.h"
#include "verification/verdict.h"

namespace foldproof {

struct SolverPlan {
  std::string name;                // of the solver
  std::vector<double> wanted;      // errors over the motion, the largest first [1]
  PerParticle mass;                // N, 0 where the motion is prescribed [kg]
  double motion = nan;             // of the reference, by which errors are divided [m]
  double end = nan, frame = nan;   // of the run, and between two frames [s]
  double formal_order = 1;         // as it claims
  double floor = 0;                // of rounding, in differences of positions [m]
  int first = 1;                   // steps a frame to begin with, a power of two
  double most_seconds = INFINITY;  // by the clock, of one run
};

/// The steps a frame to run next; 0: none. Steps are halved until three runs came to an end and the
/// error bar of the finest is a tenth of the smallest wanted error, or rounding; or until a run
/// would take more than most_seconds. They are doubled, up to a frame, while they reach the largest
/// wanted error. Where the next longer step is unstable, steps between are tried.
int next_parts(const SolverPlan& plan, const TrialLevels& runs);

/// The price of a wanted error. Seconds are of the solver's processes. LimitedBy::not_tried: the
/// step is a whole frame, the longest there is.
struct SolverPrice {
  double wanted;               // 1
  Price price;                 // applications: steps
  double unstable_step = nan;  // the next longer one, if it is not stable [s]
  std::string because = "";    // why there is none; or ""
};

struct SolverPrecision {
  SolverPlan plan;
  MethodCurve curve;  // errors include the finest run's bar; NaN: no end, or no order
  std::vector<SolverPrice> prices;
  // the finest run's distance from the reference's truth [m], NaN: not known; and how much of it
  // both errors explain
  double from_truth = nan, explained = nan;

  bool is_answered() const;
};

/// An error has a price where the halved steps show an order. It is interpolated in
/// logarithms between the two steps that bracket the error. truth: of the reference, whose
/// frames are at `times`.
SolverPrecision solver_precision(const SolverPlan& plan, const TrialLevels& runs,
                                 const CaseTruth& truth, const std::vector<double>& times);

/// A sentence for each wanted error, with the reference's cheapest method beside it; then how far
/// the solver's limit is from the reference's truth.
std::vector<std::string> solver_sentences(const SolverPrecision& solver,
                                          const PrecisionAnswer& reference);

/// As the built-in studies are recorded, under the name precision.CASE.SOLVER.
StudyRecord solver_precision_record(const SolverPrecision& solver,
                                    const PrecisionAnswer& reference);

}  // namespace foldproof
