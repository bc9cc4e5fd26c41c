// Error against cost of one method on one motion, and what a wanted error costs on it.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "convergence/work_precision/precision_problem.h"
#include "reference/dynamics/integrator.h"

namespace foldproof {

struct PrecisionRun {
  int steps;
  double error;  // largest component of the position error at the end over the motion [1]; NaN: diverged
  double applications;  // of force operators [1]
  double seconds;       // of the processor, the least of a few repeats
  double part;          // of its steps that it took: 1 unless it diverged on the way [1]
  Work work;
};

/// How a run is marked in figures; diverged: no error.
Mark mark_of(const PrecisionRun& run);

struct PrecisionCurve {
  Integrator integrator;
  std::vector<PrecisionRun> runs;  // coarse to fine
};

/// A run whose error exceeds the motion itself counts as diverged.
constexpr double lost = 1;

/// The runs of one method: from an eighth of the steps at the elastic limit on, finer by problem.ratio, until
/// the error is `finest_error` [1] and problem.least_points runs were measured, or until a run with a step
/// below the elastic limit exceeds the problem's budget, or would if work went on to grow as between the two
/// before. Runs with longer steps that exceed it are left out.
PrecisionCurve precision_curve(const Subject& subject, const PrecisionProblem& problem,
                               const PrecisionTruth& truth, const Integrator& integrator,
                               double finest_error);

/// Why a step cannot be longer at a wanted error.
enum class LimitedBy { accuracy, stability, not_tried, not_reached };

std::string_view words_of(LimitedBy limit);

/// What a wanted error costs. All NaN when it was not reached.
struct Price {
  LimitedBy limit;
  double step;          // s
  double applications;  // 1
  double seconds;
  double unfinished;  // solves in the run that reaches it [1]
};

/// From the coarsest run from which on all errors are at most `wanted` [1]; between it and the next coarser
/// one the price is interpolated, linearly in the logarithms, unless that one diverged.
Price price_at(const PrecisionCurve& curve, double end, double wanted);

}  // namespace foldproof
