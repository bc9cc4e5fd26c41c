// Where a campaign stands: its jobs, what the store knows of each, and this in words.
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

  BatchTerms terms() const;
};

/// Opens the campaign of a file, or a shipped one of that name, and brings the index up to
/// date. Throws InputError for an invalid file, a command that no campaign runs, and a case
/// that does not exist.
OpenCampaign open_campaign(const std::string& file, const std::string& out);

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
Standing stand(OpenCampaign& of, const std::function<void(const BatchJob&)>& take_missing = {});

/// Batches of all campaigns that are worked on, or are in a queue. Others are marked as ended.
std::vector<Batch> live_batches(const std::string& store);

/// Lines: counts, the work that is left, the commonest reasons of failures, conflicts.
std::string standing_text(OpenCampaign& of, const Standing& standing);

/// The same as JSON.
std::string standing_json(OpenCampaign& of, const Standing& standing);

/// One line: how many are done, run and are missing. seconds_left: of the clock; NaN: not known.
std::string watch_line(const OpenCampaign& of, const Standing& standing, double seconds_left);

/// The same as a page, with reasons, that loads itself again while jobs run.
std::string watch_page(const OpenCampaign& of, const Standing& standing, double seconds_left);

}  // namespace foldproof
