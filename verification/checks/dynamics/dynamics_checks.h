// Checks of what dynamics does: steps, momentum, symmetries, runs. One function a file, and their sum.
#pragma once

#include <vector>

#include "verification/verdict.h"

namespace foldproof {

std::vector<Check> oscillator_checks();    // oscillator_checks.cpp: the schemes as matrices
std::vector<Check> exact_motion_checks();  // exact_motion_checks.cpp: free fall, a turning pair
std::vector<Check> momentum_checks();      // momentum_checks.cpp: conservation and reversal
std::vector<Check>
step_checks();  // step_checks.cpp: lines of the schemes, filters, prescribed particles, counts
std::vector<Check> symmetry_checks();  // symmetry_checks.cpp: units, frames of reference, repetition
std::vector<Check> run_checks();       // run_checks.cpp: frames, automatic steps, stops
std::vector<Check> resume_checks();    // resume_checks.cpp: runs that go on from a checkpoint
std::vector<Check> event_checks();     // event_checks.cpp: motions that start and stop
std::vector<Check> method_checks();    // method_checks.cpp: what the paper's schemes are compared with
std::vector<Check> energy_checks();    // energy_checks.cpp: diagnostics and the balance of energy

/// All of the above, in this order.
std::vector<Check> dynamics_checks();

}  // namespace foldproof
