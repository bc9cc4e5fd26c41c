// One run of a case at one resolution, as questions about its error need it, kept in a store.
#pragma once

#include <string>
#include <vector>

#include "reference/bodies/level_set_provider.h"
#include "reference/dynamics/simulate.h"
#include "verification/cases/expectations.h"
#include "verification/files/result_store.h"

namespace foldproof {

struct LevelRun {
  std::vector<double> values;            // one a measurement
  std::vector<double> times;             // of the frames [s]
  std::vector<PerParticle3> x;           // in each frame, 3 x N, of the first N particles [m]
  std::vector<double> kinetic, elastic;  // energies in each frame [J]
  std::vector<double> contacts;   // in each frame: points that objects corrected in the last step
  std::vector<double> step_ends;  // s
  double work = 0;                // evaluations, preparations and products of all forces [1]
  double seconds = 0;             // of the clock, with others running beside
  std::string stopped;            // why the run came to no end, or ""
};

/// What is run: a case, at the resolution that its scene and schedule say.
struct Level {
  std::string label;  // for progress and for the store
  Case input_case;
  std::vector<Measurement> measurements;
  int particles;  // of these, the first ones, positions are kept
};

/// Runs the level. An error in building or running is told in `stopped`.
LevelRun run_level(const Level& level, const LevelSetProvider& level_sets);

/// The key of the level's result: of its case text, meshes, start, schedule, method and
/// measurements, and of the program.
std::string key_of(const Level& level, const std::string& program);

/// The level's run from the store, or made now and kept there. Also keeps runs that stopped.
LevelRun stored_level(const Level& level, const LevelSetProvider& level_sets, ResultStore& store,
                      const std::string& program);

/// The largest difference over the frames: the root mean square over particles, weighted with their
/// masses (N [kg]), of how far apart they are [m]. NaN where one of the runs stopped.
double field_difference(const LevelRun& a, const LevelRun& b, const PerParticle& mass);

}  // namespace foldproof
