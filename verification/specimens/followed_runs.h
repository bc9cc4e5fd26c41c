// Runs with all that they hand out, to be compared bit by bit.
#pragma once

#include <string>
#include <vector>

#include "reference/dynamics/simulate.h"
#include "reference/scene/scene.h"

namespace foldproof {

/// A run with all that was handed out.
struct Followed {
  std::vector<State> frames;
  std::vector<Diagnostics> rows;
  std::vector<Checkpoint> checkpoints;
  std::vector<std::size_t> rows_at;  // of each checkpoint: rows that came before it
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

/// The run of its scene by the system and the integrator.
Followed followed_run(const NamedRun& of, const System& system, const Integrator& integrator);

/// All numbers of the run; none if it is not what it is meant to be.
Numbers numbers_of(const NamedRun& of, const Followed& run);

/// Small runs in which all parts of the method have a share: events, sticking, layers in contact
/// with strain limits, divergence; with schemes that remember and schemes that do not.
std::vector<NamedRun> runs_of_all_parts();

}  // namespace foldproof
