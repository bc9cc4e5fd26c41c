// One job of a campaign, run to its result.
#pragma once

#include "reference/bodies/level_set_provider.h"
#include "scripts/program/campaign/batch.h"
#include "verification/files/job_store.h"

namespace foldproof {

struct JobAnswer {
  JobResult result;
  Units units;
};

/// Thrown when a job's own process was killed; no std::exception, so that it is no result.
struct JobDied {};

/// Runs the job: a simulation in this process, any other command in one of its own. Bad input is
/// refused, too little memory is out_of_memory, other errors are stopped. Passes on JobDied, and
/// where files are kept std::runtime_error, which may be of a full disk.
JobAnswer run_job(const BatchTerms& terms, const BatchJob& job, const LevelSetProvider& level_sets);

/// Runs the command with --json and reads its answer: every number of it is a value, named by its
/// place, as "positions.order", and in lists of named entries by their name. Exit code 0 holds, 1
/// fails, 2 is refused with the last line of its errors as the reason. Throws JobDied for one that
/// a signal ended, InputError for a script that an installed program does not have.
JobAnswer command_job(const BatchTerms& terms, const BatchJob& job);

/// Names of commands that a campaign's `run` can be.
std::vector<std::string> campaign_commands();

/// What the answers of a script depend on beside the program and what it is asked: seeded faults
/// and tests. "" for a command of the program.
std::string script_digest(const std::string& run);

/// Fills in who found the result, and when.
void sign(JobResult& result);

}  // namespace foldproof
