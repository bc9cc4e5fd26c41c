// Which integrator is cheapest for a case, at the error that is wanted? Every method runs the case
// with steps that are halved; the truth is where two methods agree.
#pragma once

#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "convergence/any_case/error_bar.h"
#include "convergence/any_case/level_run.h"
#include "convergence/work_precision/precision_curve.h"
#include "reference/dynamics/integrator.h"
#include "verification/verdict.h"

namespace foldproof {

/// The question: which methods, which errors, how much work.
struct PrecisionPlan {
  Case input_case;                   // with the end that is asked for
  std::vector<std::string> methods;  // asked for
  // run beside them because the truth needs methods of two families
  std::vector<std::string> for_truth;
  std::vector<double> wanted;        // errors over the motion, the largest first [1]
  double budget;                     // of one run [visits]
  std::map<std::string, int> first;  // steps a frame that each method begins with
  PerParticle mass;                  // N, 0 where the motion is prescribed [kg]
  // of the automatic step of each method, at the start [s]; infinite for fully implicit methods
  std::map<std::string, double> limits;
  int lasting_times = longer;  // a winning step must last so many times as long as the case [1]
};

/// Lets winning steps be tried at least until `end` [s], where the case that is asked
/// for is shorter.
void try_until(double end, PrecisionPlan& plan);

/// The time until which winning steps are tried [s].
inline double lasting_end(const PrecisionPlan& plan) {
  return plan.lasting_times * plan.input_case.scene.schedule.end;
}

/// The methods, checked and in the order of the table of integrators, with what the truth needs
/// beside them, and where each begins: with a step of at most four times the elastic limit at the
/// start (for explicit methods the damping limit, too), and at most a frame.
/// Throws InputError for unknown methods, and for a case without a particle that is free.
PrecisionPlan precision_plan(const Case& input_case, std::vector<std::string> methods,
                             std::vector<double> wanted, double budget,
                             const LevelSetProvider& level_sets);

/// Throws InputError for an unknown method.
Family family_of(const std::string& method);

/// Those asked for, then those that the truth needs.
std::vector<std::string> all_methods(const PrecisionPlan& plan);

/// The length of a frame, or of a shorter run [s].
double frame_of(const PrecisionPlan& plan);

/// A run to make: a method, with `parts` equal steps from frame to frame. No step is longer than a
/// frame's interval; events within a frame divide it further.
struct PrecisionTrial {
  std::string method;
  int parts = 1;      // >= 1
  double budget = 0;  // of the run, > 0 [visits]
  int times = 1;      // the run's length over the case's [1]

  bool operator==(const PrecisionTrial&) const = default;
};

/// The run with the trial's method, step and length.
Level trial_level(const Case& input_case, const PrecisionTrial& trial);

/// Runs of one method, or of another solver, by steps a frame.
using TrialLevels = std::map<int, LevelRun>;

using TrialRuns = std::map<std::string, TrialLevels>;  // by method

/// All runs so far.
struct Trials {
  TrialRuns runs;    // as long as the case
  TrialRuns longer;  // `lasting_times` times as long: do the steps that would win last?
};

/// Where the trial's run belongs.
LevelRun& run_of(Trials& trials, const PrecisionTrial& trial);

// The runs of one method over steps that are halved.

/// The first step is at most so many times the elastic limit at the start [1].
constexpr double beyond_limit = 4;

constexpr int most_parts = 1 << 20;  // steps a frame

/// A price lies between two steps: no run is made between two that are closer than this [1].
constexpr double narrow = 1.3;

/// Steps a frame to begin with: a power of two whose step is at most beyond_limit times `limit`
/// [s], and at most a frame [s].
int first_parts(double frame, double limit);

/// The finest of the halved steps, whole or not; parts 0: there is none.
std::pair<int, const LevelRun*> finest(const TrialLevels& levels);

/// The whole runs at the fine end of the ladder of halved steps, each with twice as many steps as
/// the one before, coarse to fine.
std::vector<std::pair<int, const LevelRun*>> fine_end(const TrialLevels& levels);

/// Error bar of the positions of the last of fine_end. With two runs it is three times their
/// difference, a spread; with fewer there is none.
///   formal_order  of the method
///   floor         of rounding, in differences of positions [m]
ErrorBar ladder_bar(const TrialLevels& levels, const PerParticle& mass, double formal_order,
                    double floor);

/// ladder_bar of a method's runs.
ErrorBar method_bar(const PrecisionPlan& plan, const std::string& method,
                    const TrialLevels& levels);

/// One method's best estimate of the positions: its finest run, or Richardson's extrapolation of
/// its last two where their order is asymptotic.
struct Opinion {
  std::string method;
  int parts = 0;
  bool is_extrapolated = false;
  std::vector<PerParticle3> x;  // in each kept frame, 3 x N [m]
  double half_width = nan;      // of the finest run's own error bar [m]
};

/// Errors are root mean squares over the free particles, weighted with their masses, in the worst
/// frame, over the motion: the largest distance from the start, measured alike.
struct CaseTruth {
  // the first has the smallest error bar, the second the next of another family; if no other family
  // knows more than the motion's size, of another method
  Opinion first, second;
  double motion = nan;       // of the first [m]
  double uncertainty = nan;  // how far apart they are, over the motion [1]; NaN: there are no two
};

/// The truth that the runs allow; none where nothing moves by more than a billionth of the cloth's
/// extent. Opinions are chosen by their own error bars, never by how well they agree; one whose bar
/// is longer than the motion does not count.
CaseTruth case_truth(const PrecisionPlan& plan, const TrialRuns& runs);

/// An error is told where the truth is known to a tenth of it [1].
constexpr double truth_part = 0.1;

/// The least error that the truth is good for [1]; NaN without a truth.
inline double least_error(const CaseTruth& truth) { return truth.uncertainty / truth_part; }

/// One method on the case, or another solver; all its runs, coarse to fine.
struct MethodCurve : PrecisionCurve {
  ErrorBar bar;  // of the positions, by its own halved steps; without three: inconclusive
  // of steps between which the largest stable step lies [s]; NaN: no stable one, no unstable one
  double stable_step = nan, unstable_step = nan;
};

/// The fewest steps a frame that are no longer than `step` [s].
int parts_of(const PrecisionPlan& plan, double step);

/// The curves of all methods, those for the truth last.
std::vector<MethodCurve> method_curves(const PrecisionPlan& plan, const Trials& trials,
                                       const CaseTruth& truth);

/// The steps a frame between which the price of a wanted error lies: with `few` the error is
/// larger, or the step is unstable, if only in a longer run. few 0: there is no price, or
/// none was tried.
struct Bracket {
  int few = 0, many = 0;
};

Bracket bracket_of(const PrecisionPlan& plan, const MethodCurve& curve, double wanted);

/// The runs to make next; none when all is answered, or exceeds the budget. A method's steps are
/// doubled until they are unstable (those of fully implicit methods, until they miss the largest
/// wanted error), and halved until its error is the least wanted one and three runs came to an end;
/// unless the next wanted error, by the order that it showed, costs more than the budget, or
/// `dearest` times what the cheapest method pays. Then both opinions on the truth are refined until
/// they agree. Then brackets of prices of methods that might be cheapest are narrowed to a quarter
/// of a step. Then the steps of the cheapest methods are tried until lasting_end, with at most
/// `dearest_trial` times the budget; where one does not last, the search goes on.
std::vector<PrecisionTrial> next_trials(const PrecisionPlan& plan, const Trials& trials);

constexpr double dearest = 16;
constexpr double dearest_trial = 20;  // with half the step, twice as much

/// The cost of one error with one method.
struct MethodPrice {
  std::string method;
  Price price;
  double spacing = nan;  // of the steps between which it lies [1]
  // The price's step, or the next shorter one with a whole number of steps a frame: this one is
  // tried until lasting_end and may be used [s].
  double whole_step = nan;
  double over_best = nan;  // its work over the cheapest one's [1]
  bool is_tied = false;    // with the cheapest: closer than the spacing of what was tried
  // of the run until lasting_end [1]; NaN: there was none, or it exceeded its budget
  double energy_gain = nan;
  std::string because = "";  // why there is none; or ""
};

inline bool is_priced(const MethodPrice& price) { return !std::isnan(price.price.applications); }

/// The prices of one wanted error, the cheapest first, by work; those that have none last. None of
/// them has one where the truth is not known to a tenth of the error.
struct PriceList {
  double wanted;
  std::vector<MethodPrice> prices;
};

PriceList price_list(const PrecisionPlan& plan, const CaseTruth& truth,
                     const std::vector<MethodCurve>& curves, double wanted);

/// The methods that win, or tie, by work or by seconds.
std::vector<const MethodPrice*> winners(const PriceList& list);

/// A run that the budget ended.
struct EndedRun {
  std::string method = "";
  int parts = 0;       // steps a frame; 0: there is none
  double part = 0;     // of the time that it was to reach [1]
  double seconds = 0;  // of the processor
};

struct PrecisionAnswer {
  PrecisionPlan plan;
  CaseTruth truth;
  std::vector<MethodCurve> curves;
  std::vector<PriceList> lists;
  EndedRun furthest = {};  // of those that the budget ended
};

PrecisionAnswer precision_answer(const PrecisionPlan& plan, const Trials& trials);

// The answer in words, figures and tables.

/// One sentence for each wanted error: which method is cheapest, with which step, what the others
/// cost over it, and which do not reach the error.
std::vector<std::string> precision_sentences(const PrecisionAnswer& answer);

/// How the truth is known, in a sentence.
std::string truth_in_words(const PrecisionAnswer& answer);

/// Where no method has a price: the --errors that the truth allows or, if the budget ended the
/// runs, which --until or --effort to try. "" elsewhere.
std::string advice_in_words(const PrecisionAnswer& answer);

/// Why methods appear that nobody requested; "" if none does.
std::string for_truth_in_words(const PrecisionAnswer& answer);

/// As the built-in studies are recorded, under the name precision.CASE. seconds: that it took [s].
StudyRecord precision_record(const PrecisionAnswer& answer, double seconds);

}  // namespace foldproof
