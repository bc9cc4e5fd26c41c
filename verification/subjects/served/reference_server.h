// The reference at the solver's end of the pipe.
#pragma once

#include <string>

namespace foldproof {

/// What the served reference declares, and how it answers.
struct ServedReference {
  std::string integrator = "C";
  bool is_single = false;  // answers in f4; computes in f8 all the same
};

/// Likewise as a solver that declares all and never moves: its mapping of a scene is the scene's
/// hash, in which numbers count by their first seven digits.
int serve_still();

/// Answers until `stop` or the end of the pipe; returns the exit code. Throws InputError for an
/// unknown integrator, and if FOLDPROOF_IN is not set.
int serve_reference(const ServedReference& served);

}  // namespace foldproof
