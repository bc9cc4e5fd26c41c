// One run of a case at one resolution, as questions about its error need it, kept in a store.
#pragma once

#include <string>
#include <vector>

#include "convergence/any_case/framed_run.h"
#include "reference/bodies/level_set_provider.h"
#include "reference/dynamics/simulate.h"
#include "verification/cases/expectations.h"
#include "verification/files/result_store.h"

namespace foldproof {

/// x: of the first N particles, or of those that the level names.
struct LevelRun : FramedRun {
  std::vector<double> values;            // one a measurement
  std::vector<double> kinetic, elastic;  // energies in each frame [J]
  std::vector<double> contacts;   // in each frame: points that objects corrected in the last step
  std::vector<double> step_ends;  // s
  double clock = nan;             // by the clock [s]; of another solver only, through the pipe
  double work = 0;                // evaluations, preparations and products of all forces [1]
};

/// One run of the ladder: a case at the resolution of its scene and schedule.
struct Level {
  std::string label;  // for progress and for the store
  Case input_case;
  std::vector<Measurement> measurements;
  int particles;                 // of these, the first ones, positions are kept
  std::vector<int> common = {};  // of these instead, if there are any
};

/// Runs the level; shows `progress` the part that is done. An error in building or running is
/// told in `stopped`.
LevelRun run_level(
    const Level& level, const LevelSetProvider& level_sets,
    const Progress& progress = [](double) {});

/// The key of the level's result: of its case text, meshes, start, schedule, method and
/// measurements, and of the program.
std::string key_of(const Level& level, const std::string& program);

/// The level's run from the store, or made now and kept there. Also keeps runs that stopped. What
/// the store has and is no whole run is made again.
LevelRun stored_level(
    const Level& level, const LevelSetProvider& level_sets, ResultStore& store,
    const std::string& program, const Progress& progress = [](double) {});

/// The largest difference over the frames: the root mean square over particles, weighted with their
/// masses (N [kg]), of how far apart they are [m]. NaN where one of the runs stopped.
double field_difference(const LevelRun& a, const LevelRun& b, const PerParticle& mass);

}  // namespace foldproof
