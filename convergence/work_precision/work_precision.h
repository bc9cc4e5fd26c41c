// Parts of the study work-precision: one curve a method, prices of an error, slow motion.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "convergence/study.h"
#include "convergence/work_precision/longer_run.h"
#include "convergence/work_precision/precision_problem.h"
#include "reference/dynamics/integrator.h"
#include "verification/subject.h"

namespace foldproof {

// Methods on the slow motion that remains under heavy damping: a part of work-precision.

/// An overdamped oscillator creeps home at a rate near k/c. The rate under A, B and C against
/// the step: a figure, that A keeps its second order, and that C has the error derived above
/// its definition.
void add_slow_motion(const Subject& subject, StudyResult& result);

// Error against cost of one method on one motion, and what a wanted error costs on it.

struct PrecisionRun {
  int steps;
  // largest component of the position error at the end over the motion [1]; NaN: diverged
  double error;
  double applications;  // of force operators [1]
  double seconds;       // of the processor, the least of a few repeats
  double part;          // of its steps that it took: 1 unless it diverged on the way [1]
  Work work;
};

/// How a run is marked in figures; diverged: no error.
Mark mark_of(const PrecisionRun& run);

struct PrecisionCurve {
  Integrator integrator;
  std::vector<PrecisionRun> runs;      // coarse to fine
  std::vector<LongerRun> longer = {};  // of steps that were asked whether they last
};

/// A run whose error exceeds the motion itself counts as diverged.
constexpr double diverged_error = 1;

/// The runs of one method: from an eighth of the steps at the elastic limit on, finer by
/// problem.ratio, until the error is `finest_error` [1] and problem.min_points runs were
/// measured, or until a run with a step below the elastic limit exceeds the problem's budget, or
/// would if work went on to grow as between the two before. Runs with longer steps that exceed
/// it are left out.
PrecisionCurve precision_curve(const Subject& subject, const PrecisionProblem& problem,
                               const PrecisionTruth& truth, const Integrator& integrator,
                               double finest_error);

/// Why a step cannot be longer at a wanted error. longer_run: longer steps reach it, but are
/// unstable in a longer run.
enum class LimitedBy { accuracy, stability, longer_run, not_tried, not_reached };

std::string_view name_of(LimitedBy limit);

/// Cost of reaching a given error. All NaN when it was not reached.
struct Price {
  LimitedBy limit;
  double step;          // s
  double applications;  // 1
  double seconds;
  double unfinished;  // solves in the run that reaches it [1]
};

/// From the coarsest run from which on all errors are at most `wanted` [1]; between it and the next
/// coarser one the price is interpolated, linearly in the logarithms, unless that one diverged.
/// Steps that a longer run showed to be unstable have no price: the next shorter run has it.
Price price_at(const PrecisionCurve& curve, double end, double wanted);

// Measurements passed between the parts of the work-precision study.

/// One motion, what is known of it, and every method on it.
struct PrecisionScene {
  PrecisionProblem problem;
  PrecisionTruth truth;
  std::vector<PrecisionCurve> curves;  // in the order of the table of integrators
};

/// The errors that are asked for, over the motion [1].
constexpr std::array<double, 2> wanted_errors = {0.01, 0.001};

/// The method of a scene by its name; InputError if it has not run.
const PrecisionCurve& curve_of(const PrecisionScene& scene, std::string_view method);

/// A cost that methods are compared by.
struct Currency {
  std::string name;
  double Price::*cost;
};

const std::array<Currency, 2> currencies = {
    {{"work", &Price::applications}, {"seconds", &Price::seconds}}};

/// The cheapest method of a scene at a wanted error; the next one, which is the cheapest of those
/// that are not tied with it (they cost more than it does times the ratio of two steps that were
/// tried); and scheme C.
struct Podium {
  std::string first = "none", second = "none";
  Price best{LimitedBy::not_reached, nan, nan, nan, nan}, next = best, scheme_C = best;
};

Podium podium(const PrecisionScene& scene, double wanted, const Currency& currency);

/// Asks whether the steps last with which the contenders reach each wanted error; where one does
/// not, a shorter one, or another method, is asked in its place.
void ask_longer_runs(const Subject& subject, PrecisionScene& scene);

/// The curves of the cheapest method, of the next, and of those that cost about as much as the
/// cheapest: less than the ratio of two steps that were tried.
std::vector<size_t> contenders(const PrecisionScene& scene, double wanted,
                               const Currency& currency);

std::vector<NamedFinding> precision_findings(const std::vector<PrecisionScene>& scenes);

/// Error against step, work and seconds of one scene.
std::vector<Figure> precision_figures(const PrecisionScene& scene);

/// Which method is cheapest; every method's price; which steps last; every run.
std::vector<Table> precision_tables(const std::vector<PrecisionScene>& scenes);

}  // namespace foldproof
