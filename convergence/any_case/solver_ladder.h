// A case run by another solver with steps that are halved: how far is its run from its limit, and
// its limit from the reference's?
#pragma once

#include <string>
#include <vector>

#include "convergence/any_case/converge.h"
#include "reference/bodies/level_set_provider.h"
#include "verification/subjects/suite/trial.h"

namespace foldproof {

/// Those of the measurements that positions and velocities show: other programs tell nothing else.
std::vector<Measurement> shown_by_states(const std::vector<Measurement>& measurements);

/// Equal steps from frame to frame.
struct SolverSteps {
  long frames = 0;      // of the run, without the start
  double interval = 0;  // between them [s]
  long a_frame = 0;     // steps in the first level
};

/// No step is longer than the case's `time.step`, or without one, than its safety times the elastic
/// limit at the start. Throws InputError if the end is not a whole number of frames.
SolverSteps solver_steps(const Scene& scene, const BuiltScene& built);

/// A case on another solver's trial.
class SolverLadder {
 public:
  /// plan: its measurements are reduced to shown_by_states. solver: must outlive it. Throws
  /// InputError for a case that the protocol cannot say, or that the solver does not offer.
  SolverLadder(LadderPlan plan, Trial& solver, const LevelSetProvider& level_sets);

  /// The run with 2^k times the steps of the first level. If the solver fails, `stopped` says why.
  /// Seconds are of the solver's processes; work counts steps.
  LevelRun run(int k);

  /// Likewise, with so many steps a frame.
  LevelRun run_with(long a_frame);

  /// Reads all levels, coarse to fine. A solver that claims no order is read as of first order.
  LadderAnswer answer(const std::vector<LevelRun>& runs);

  const SolverSteps& steps() const { return steps_; }

 private:
  LevelRun measured(long a_frame, const std::vector<Snapshot>& frames) const;

  LadderPlan plan_;
  Trial& solver_;
  BuiltScene built_;
  PortableScene portable_;
  SolverSteps steps_;
};

/// The finest runs of a solver and of the reference, held against each other.
struct SolverGap {
  double distance = 0;                       // largest over the frames, root mean square [m]
  double solver_bar = 0, reference_bar = 0;  // of their steps [m]
  bool are_estimates = false;                // the bars; else at least one is a spread

  bool is_beyond_steps() const { return are_estimates && distance > solver_bar + reference_bar; }
};

SolverGap solver_gap(const LevelRun& solver, const LadderAnswer& solver_answer,
                     const LevelRun& reference, const LadderAnswer& reference_answer,
                     const PerParticle& mass);

std::string in_words(const SolverGap& gap, const std::string& solver);

}  // namespace foldproof
