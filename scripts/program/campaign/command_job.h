// A job that is a command of the program, in a process of its own.
#pragma once

#include "scripts/program/campaign/run_job.h"

namespace foldproof {

/// Runs the command with --json and reads its answer: every number of it is a value, named by its
/// place, as "positions.order", and in lists of named entries by their name. Exit code 0 holds, 1
/// fails, 2 is refused with the last line of its errors as the reason. Throws JobDied for one that
/// a signal ended: the job has no result.
JobAnswer command_job(const BatchTerms& terms, const BatchJob& job, const Progress& progress);

}  // namespace foldproof
