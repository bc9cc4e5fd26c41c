// The reference in another process, as a subject: what the checks ask goes over the pipe.
#pragma once

#include "verification/subject.h"
#include "verification/subjects/pipe/piped_solver.h"

namespace foldproof {

/// It offers steps, forces, damping and energy of scenes that the protocol can express, and answers
/// with the bits that the reference gives in this process. Scenes that are prepared at the same
/// time have processes of their own. For one thread.
///   command   one that serves the reference: `foldproof serve`
Subject piped_reference(const SolverCommand& command);

}  // namespace foldproof
