// One run of a case at one resolution, as questions about a case need it, kept in a store.
#pragma once

#include <string>
#include <vector>

#include "convergence/work_precision/precision_curve.h"
#include "reference/bodies/level_set_provider.h"
#include "reference/dynamics/simulate.h"
#include "verification/cases/expectations.h"
#include "verification/files/result_store.h"

namespace foldproof {

/// A run that a store keeps. Questions about a case add what else they need of it.
struct FramedRun {
  std::vector<double> times;    // of the frames [s]
  std::vector<PerParticle3> x;  // in each of them, 3 x N [m]
  double seconds = 0;           // of the processor, in the run's own thread
  std::string stopped;          // why the run came to no end, or ""
};

/// It came to its end.
bool is_whole(const FramedRun& run);

/// The run as the store has it: arrays "times", "positions", "seconds", text "stopped".
StoredResult packed_frames(const FramedRun& run);

/// Fills in what packed_frames kept of a run of N particles; false where something
/// of it is missing.
bool unpack_frames(const StoredResult& kept, Eigen::Index particles, FramedRun& run);

/// The array of this name; empty where there is none.
std::vector<double> array_of(const StoredResult& kept, const std::string& name);

// Distances: root mean squares over the particles, by mass (N [kg], some > 0).

/// The longest side of the box around x, 3 x N [m].
double longest_side(const PerParticle3& x);

/// Differences of positions, or of numbers, of this size at most are rounding over a run, no error
/// of discretization.
double rounding_floor(double size);

/// The root mean square over the particles of |u_i|, in the unit of u.
double mean_square_root(const PerParticle3& u, const PerParticle& mass);

/// The largest distance over the frames that both runs have, each 3 x N [m]; 0 without a frame, NaN
/// where a position is none.
double largest_difference(const std::vector<PerParticle3>& a, const std::vector<PerParticle3>& b,
                          const PerParticle& mass);

/// The same; NaN where they are not the same frames, or there is none.
double frame_distance(const std::vector<PerParticle3>& a, const std::vector<PerParticle3>& b,
                      const PerParticle& mass);

/// frame_distance of two runs [m]; NaN where one of them stopped.
double field_difference(const FramedRun& a, const FramedRun& b, const PerParticle& mass);

/// The largest distance of a run from its first frame [m].
double largest_motion(const std::vector<PerParticle3>& x, const PerParticle& mass);

/// x: of the first N particles, or of those that the level names. Of long trials only some frames
/// are kept; of trials longer than the case only the first and the last.
struct LevelRun : FramedRun {
  long steps = 0;
  Work work;
  double clock = nan;  // by the clock [s]; of another solver only, through the pipe
  // of a level that is no trial
  std::vector<double> values;            // one a measurement
  std::vector<double> kinetic, elastic;  // energies in each frame [J]
  std::vector<double> contacts;   // in each frame: points that objects corrected in the last step
  std::vector<double> step_ends;  // s
  // of a trial
  double part = 0;         // of the time that it was to reach [1]
  LongerEnergy energy{};   // of the free particles, in frames
  double over_budget = 0;  // the budget at which it was ended [visits]; 0: it was not
};

/// One run to make: a case at the resolution of its scene and schedule.
struct Level {
  std::string label;  // for progress and for the store
  Case input_case;
  std::vector<Measurement> measurements;
  int particles;                 // of these, the first ones, positions are kept
  std::vector<int> common = {};  // of these instead, if there are any
  // A trial is a run for the search for the cheapest method: what counts is where the cloth was,
  // and what it cost. It ends at the first frame at which it has taken more visits than this; 0:
  // it is none.
  double budget = 0;
  int times = 1;  // of a trial: its length over the case's [1]
};

/// Where runs are kept, and who made them.
struct KeptRuns {
  const LevelSetProvider& level_sets;
  ResultStore& store;
  std::string program;  // its identity
};

/// Visits of a spring, a hinge, or a point or pair that is asked about contact: what a run costs,
/// about alike for each [1].
double visits(const Scene& scene, const Work& work);

/// Runs the level; shows `progress` the part that is done. An error in building or running is
/// told in `stopped`. A trial's seconds are the least of a few runs, without building.
LevelRun run_level(
    const Level& level, const LevelSetProvider& level_sets,
    const Progress& progress = [](double) {});

/// The key of the level's result: of its case text, meshes, start, schedule, method and
/// measurements, and of the program.
std::string key_of(const Level& level, const std::string& program);

/// The level's run from the store, or made now and kept there. Also keeps runs that stopped. What
/// the store has and is no whole run is made again, as is a trial that a smaller budget ended.
LevelRun stored_level(
    const Level& level, const KeptRuns& by, const Progress& progress = [](double) {});

}  // namespace foldproof
