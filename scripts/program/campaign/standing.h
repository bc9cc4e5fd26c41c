// Where a campaign stands: its jobs, and what the store knows of each.
#pragma once

#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "convergence/campaigns/campaign.h"
#include "convergence/campaigns/job_keys.h"
#include "scripts/program/campaign/batch.h"
#include "verification/files/job_store.h"

namespace foldproof {

/// A campaign, its store, and the keys of its jobs.
struct OpenCampaign {
  Campaign campaign;
  std::string folder;  // of its tables and pages: OUT/campaigns/NAME
  std::string store;   // OUT/store, absolute
  std::string program;
  JobKeys keys;
  JobIndex index;
  std::vector<std::string> varied;
};

/// Opens the campaign of a file, or a shipped one of that name, and brings the index up to
/// date. Throws InputError for an invalid file, a command that no campaign runs, and a case
/// that does not exist.
OpenCampaign open_campaign(const std::string& file, const std::string& out);

/// Assignments of job i, as the campaign names them.
std::vector<Assignment> assignments_of(OpenCampaign& of, size_t i);

std::string label_of(const OpenCampaign& of, const std::vector<Assignment>& set);

/// Job i, the case by its file.
BatchJob batch_job(OpenCampaign& of, size_t i);

struct Standing {
  std::map<JobEnd, size_t> ended;
  size_t crashed = 0;
  size_t elsewhere = 0;  // in a batch that runs now
  size_t missing = 0;    // in none
  double seconds = 0;    // of the processor, of the jobs that ended

  /// How many did not hold, for each end and reason. What a reason has in brackets, as the step at
  /// which a run diverged, is left out.
  std::map<std::pair<JobEnd, std::string>, size_t> reasons;

  size_t done() const;
};

/// Looks up every job. `take_missing`, unless it is empty, gets each that no live batch has, once.
/// Batches whose engine says that they are over are marked as ended.
Standing stand(OpenCampaign& of, const std::function<void(const BatchJob&)>& take_missing);

/// Batches that an engine still has, of this campaign or of all.
std::vector<Batch> live_batches(const std::string& store);

/// Whether a result answers what the campaign asks: frames that it wants may be missing.
bool answers(const OpenCampaign& of, const JobResult& result);

}  // namespace foldproof
