// How far is a case's run from its limit? The errors of its steps, by halving every step.
#pragma once

#include <string>
#include <vector>

#include "convergence/any_case/error_bar.h"
#include "convergence/any_case/level_run.h"
#include "verification/verdict.h"

namespace foldproof {

/// The ladder: `levels` runs, each with half the steps of the one before.
struct LadderPlan {
  Case input_case;  // with the method and the end that are asked for
  int levels = 4;   // >= 3
  std::vector<Measurement> measurements;
};

/// The case's own: its [[quantity]] tables, or the usual ones.
std::vector<Measurement> measurements_of(const Case& input_case);

/// The plan's level k, every step of the first divided by 2^k. step_ends: of level 0; not
/// asked for k = 0.
Level time_level(const LadderPlan& plan, int k, const std::vector<double>& step_ends);

/// `ends`, with each step divided evenly into `parts`; ends themselves stay to the bit. start: of
/// the first step [s].
std::vector<double> divide_steps(const std::vector<double>& ends, double start, int parts);

/// The formal order in space: of springs and hinges on a sheet that bends smoothly.
constexpr double order_in_space = 2;

/// One quantity over the ladder, read.
struct QuantityOverLevels {
  std::string name, unit;
  std::vector<double> values;       // one a level; empty for positions
  std::vector<double> differences;  // of neighbouring levels
  ErrorBar bar;                     // of the finest level
  // of level 0, the case as it stands: its distance to the finest level and that level's bar
  double first_error;
  // of a ladder in space: the error that its steps leave in each level; else NaN
  double step_error = std::numeric_limits<double>::quiet_NaN();
};

/// Positions over the levels; each run has those of the same particles. scene: of level 0.
QuantityOverLevels positions_over_levels(const Scene& scene, const std::vector<LevelRun>& runs,
                                         double formal_order);

/// The m-th measurement, `of`, over the levels. Differences at or below 1000 roundings of the
/// finest value have no order; of counts, whole at every level, only a difference of 0.
QuantityOverLevels value_over_levels(const Measurement& of, size_t m,
                                     const std::vector<LevelRun>& runs, double formal_order);

struct LadderAnswer {
  std::string scene, method;
  std::string in;                              // "time" or "space"
  std::vector<double> sizes;                   // mean step [s], or edge [m], of each level
  std::vector<double> work, seconds;           // of each level
  std::vector<std::string> stopped;            // why a level came to no end, or ""
  std::vector<QuantityOverLevels> quantities;  // positions first
  std::vector<int> particles = {};             // of each level
  double mean_step = std::numeric_limits<double>::quiet_NaN();  // of the finest level [s]
  std::string refined_by = {};  // of a ladder in space: how its meshes became finer
  // overrides that make each level, of a ladder in space
  std::vector<std::vector<std::string>> overrides = {};
  std::vector<std::string> warnings = {};  // a sentence each
  // that the method, or the mesh, should have; NaN: no order is known
  double formal_order = std::numeric_limits<double>::quiet_NaN();
  std::string work_name = "operator applications";
  std::vector<double> clock = {};  // of each level, of another solver: through the pipe [s]

  /// Visits of all forces to all particles, of level k: what its run costs.
  double cost(size_t k) const { return work[k] * particles[k]; }
};

/// Reads the runs of all levels, coarse to fine, of a method or a mesh of this order: all of an
/// answer but sizes, particles, and what only one kind of ladder has.
LadderAnswer ladder_answer(const Scene& scene, const std::string& in,
                           const std::vector<Measurement>& measurements,
                           const std::vector<LevelRun>& runs, double formal_order);

/// ladder_answer of a ladder in time.
LadderAnswer time_answer(const LadderPlan& plan, const std::vector<LevelRun>& runs,
                         double formal_order);

// The answer as evidence: curves of differences, tables, and a sentence.

/// Whether the positions of a method, or mesh, converge with its order: yes, if they have settled
/// within same_order of it; no, if they have settled below, and the last order came no nearer by a
/// quarter of what it lacks (an order that is reached comes nearer by half at each level).
enum class OrderVerdict { yes, no, cannot_tell };
std::string_view name_of(OrderVerdict verdict);  // "yes", "no", "cannot tell"

OrderVerdict order_verdict(const LadderAnswer& answer);

/// Whether another level may give a verdict, or let a number settle that has an order.
bool may_settle(const LadderAnswer& answer);

/// "Second order: yes, the last orders are 1.98 and 2.01." The verdict with its reason; then the
/// case's own error, and what half of it costs.
std::string order_in_words(const LadderAnswer& answer);

/// How large the error of the case as it stands is, in one or two sentences.
std::string in_words(const LadderAnswer& answer);

/// Letters, digits and hyphens, as names of studies have them.
std::string as_name(const std::string& words);

/// Says how to halve the error of the positions, and at which price. In the asymptotic range, steps
/// (edges) are divided by 2^(1/order), and the cost grows as between the two finest levels. Outside
/// it, the sentence names the first level whose measured error is at most half of the first one's,
/// or says that no level does, or that nothing is known.
std::string how_to_halve(const LadderAnswer& answer);

/// One mark a difference of the quantity: measured in the asymptotic range, which ends at the
/// finest pair and reaches back as long as neighbouring orders agree within same_order; unfinished
/// (drawn hollow) outside it.
std::vector<Mark> range_marks(const QuantityOverLevels& quantity);

/// The study "converge.CASE.METHOD.in-time" (or in-space): positions and all other quantities over
/// the levels, in figures with the method's order as their slope; quantities with order, limit, bar
/// and reading, and levels with their cost, in tables. predictable: how long the positions are, in
/// words; "" if nobody asked.
StudyRecord study_of(const LadderAnswer& answer, const std::string& predictable = {});

}  // namespace foldproof
