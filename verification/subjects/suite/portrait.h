// The scene that pictures of solvers show side by side.
#pragma once

#include <string>

#include "verification/subjects/suite/trial.h"

namespace foldproof::suite {

/// A sheet that has fallen on a ball, in one solver.
struct Portrait {
  PortableScene scene;   // before the fall, with the ball
  std::string about;     // it, in words
  PerParticle3 x;        // then [m]; empty if there is none
  std::string why_none;  // in words
};

/// Starts the solver once more. A failure of it becomes `why_none`.
Portrait portrait_of(const SolverCommand& command);

}  // namespace foldproof::suite
