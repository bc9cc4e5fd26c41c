// One job of a campaign, run to its result.
#pragma once

#include "reference/bodies/level_set_provider.h"
#include "scripts/program/campaign/batch.h"
#include "verification/files/job_store.h"
#include "verification/verdict.h"

namespace foldproof {

struct JobAnswer {
  JobResult result;
  Units units;
};

/// Thrown when a job's own process was killed; no std::exception, so that it is no result.
struct JobDied {};

/// Runs the job: a simulation in this process, any other command in one of its own. Bad input is
/// refused, too little memory is out_of_memory, other errors are stopped. Passes on JobDied, what
/// `progress` throws that is no std::exception, and where files are kept std::runtime_error, which
/// may be of a full disk.
JobAnswer run_job(const BatchTerms& terms, const BatchJob& job, const LevelSetProvider& level_sets,
                  const Progress& progress);

/// The words of the command that does what the job does, the program's name left out.
std::vector<std::string> words_of(const std::string& run, const std::vector<Assignment>& set);

/// Fills in who found the result, and when.
void sign(JobResult& result);

}  // namespace foldproof
