// Motions whose end is known well enough to tell which integrator reaches a wanted accuracy
// at which price.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "convergence/work_precision/precision_curve.h"
#include "reference/scene/scene.h"
#include "verification/subject.h"

namespace foldproof {

/// Source of the reference end state. oracle: GSL, which shares no formula with the solver;
/// runge_kutta: extrapolated RK4, for meshes on which the oracle would take minutes.
enum class FirstOpinion { oracle, runge_kutta };

struct PrecisionProblem {
  std::string name;         // part of the findings' names
  std::string description;  // "the heavily damped sheet"
  Scene scene;              // its integrator is replaced by each of the table
  double end;               // s
  FirstOpinion first;
  std::string second;  // the scheme whose extrapolation is the second opinion
  double ratio;        // of the numbers of steps of neighbouring runs, > 1
  int min_points;      // measured runs of a curve before it may end
  int finest;          // steps of the second opinion's coarser run over those at the elastic limit
  double budget;       // largest work of one judged run [operator applications]
};

/// Where the motion ends, and the scales with which to speak of it.
struct PrecisionTruth {
  PerParticle3 x;  // at the end, 3 x N [m]
  double motion;   // largest distance of any particle from its start over the whole run [m]
  // of any component of x, over the motion [1]: the first opinion's own, and how far the
  // second is from it
  double uncertainty;
  double elastic_limit;   // at the start, the solver's bound [s]
  double two_over_omega;  // 2/omega of the fastest mode of the start, by power iteration [s]
  double two_over_c;      // 2/c of the fastest damping rate of the start, by power iteration [s]
};

/// One run with constant steps.
struct RunPlan {
  double end;       // s
  int steps;        // >= 1
  double farthest;  // a particle farther from its start than this ends the run as diverged [m]
  double budget;    // work at which the run ends [operator applications]
  std::function<void(const State&)> seen = {};  // called after each step
};

enum class Ending { reached, diverged, over_budget };

struct PlannedRun {
  Ending ending;
  int steps;  // taken, fewer than planned unless the end was reached
  State last;
  Work work;
  double farthest;  // that any particle got from its start [m]
};

/// Evaluations, preparations and products of all forces: one visit to every spring and hinge each.
double operator_applications(const Work& work);

/// Runs the scene with its integrator. NaN, a lost element or a particle beyond
/// farthest is divergence.
PlannedRun run_planned(const Subject& subject, const Scene& scene, const RunPlan& plan);

/// A run and its kinetic energy.
struct EnergyRun : PlannedRun {
  LongerEnergy energy;  // NaN: the run did not reach its end
  double energy_left;   // at the end over the largest [1]
};

/// run_planned; the added time of the energy begins after `from` [s].
EnergyRun run_with_energy(const Subject& subject, const Scene& scene, RunPlan plan, double from);

/// Both opinions; may take a second.
PrecisionTruth truth_of(const Subject& subject, const PrecisionProblem& problem);

/// Largest difference of two ends, of any component [m]; NaN stays NaN.
double largest_distance(const PerParticle3& p, const PerParticle3& q);

/// The damped hinge, the lightly and the heavily damped sheet, the stiff statue.
std::vector<PrecisionProblem> precision_problems(Tier tier);

/// A sheet that hangs by its upper corners, released from waves; every part of it has the
/// relaxation time `relaxation` (damping over stiffness) [s].
Scene hanging_sheet(int cells, double relaxation);

}  // namespace foldproof
