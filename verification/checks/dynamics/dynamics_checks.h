// Checks of dynamics: solves, steps, runs. One function per file; the list of all is
// verification/checks.cpp.
#pragma once

#include <vector>

#include "verification/verdict.h"

namespace foldproof {

std::vector<Check> solver_checks();              // conjugate gradients for the implicit velocity
std::vector<Check> unsymmetric_solver_checks();  // Newton steps whose matrix is not symmetric
std::vector<Check> cached_terms_checks();        // time and memory that cached terms save
std::vector<Check> oscillator_checks();          // the schemes as matrices
std::vector<Check> exact_motion_checks();        // free fall, a turning pair
std::vector<Check> momentum_checks();            // conservation and reversal
std::vector<Check> step_checks();  // lines of the schemes, filters, prescribed particles, counts
std::vector<Check> symmetry_checks();      // units, frames of reference, repetition
std::vector<Check> run_checks();           // frames, automatic steps, stops
std::vector<Check> resume_checks();        // runs that go on from a checkpoint
std::vector<Check> thread_checks();        // runs on several threads
std::vector<Check> reuse_checks();         // what a run keeps for its next steps
std::vector<Check> event_checks();         // motions that start and stop
std::vector<Check> method_checks();        // the methods for comparison with the paper's schemes
std::vector<Check> other_method_checks();  // methods of other papers, as models
std::vector<Check> energy_checks();        // diagnostics and the balance of energy

/// A table for statements that are true or false, one per row.
Table no_statements();

/// How many statements are false; NaN without any.
double count_false(const Table& statements);

}  // namespace foldproof
