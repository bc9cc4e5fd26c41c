// Runs with all their output, to be compared bit by bit.
#pragma once

#include <string>
#include <vector>

#include "reference/dynamics/simulate.h"
#include "reference/scene/scene.h"

namespace foldproof {

/// A run with all its output.
struct Followed {
  std::vector<State> frames;
  std::vector<Diagnostics> rows;
  std::vector<Checkpoint> checkpoints;
  std::vector<std::size_t> rows_at;  // of each checkpoint: number of rows before it
  RunResult result;
};

Followed followed_run(const System& system, const Integrator& integrator, const State& start,
                      const Schedule& schedule);
Followed followed_rest(const System& system, const Integrator& integrator,
                       const Checkpoint& checkpoint, const Schedule& schedule);

/// Numbers of a run in their order; two runs are compared bit by bit.
using Numbers = std::vector<double>;

/// Output after the given numbers of frames, rows and checkpoints, and the result of the
/// run; no clock time.
Numbers numbers_after(const Followed& run, std::size_t frames, std::size_t rows,
                      std::size_t checkpoints);

/// NaN for different amounts of numbers.
double bits_that_differ(const Numbers& a, const Numbers& b);

struct NamedRun {
  std::string name, integrator;
  Scene scene;
  bool stops = false;  // before its end
};

/// The run of its scene with this system and integrator.
Followed followed_run(const NamedRun& of, const System& system, const Integrator& integrator);

/// All numbers of the run; none if the run is invalid.
Numbers numbers_of(const NamedRun& of, const Followed& run);

/// Small runs that use all parts of the method: events, sticking, layers in contact with strain
/// limits, divergence; with one-step and multi-step schemes.
std::vector<NamedRun> runs_of_all_parts();

}  // namespace foldproof
