#include "scripts/program/campaign/standing.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "scripts/program/campaign/run_job.h"
#include "scripts/program/campaign/slurm.h"
#include "scripts/program/campaign/work.h"
#include "scripts/program/command_line/input_files.h"
#include "scripts/program/command_line/suggestions.h"
#include "scripts/program/data_folder.h"
#include "scripts/program/provenance.h"

namespace foldproof {

namespace {

namespace fs = std::filesystem;

const std::string campaign_ending = ".campaign.toml";

/// Names of the campaigns in a folder.
std::vector<std::string> campaigns_in(const std::string& folder) {
  std::vector<std::string> names;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored))
    if (const std::string name = entry.path().filename().string(); name.ends_with(campaign_ending))
      names.push_back(name.substr(0, name.size() - campaign_ending.size()));
  std::ranges::sort(names);
  return names;
}

std::string campaign_file(const std::string& typed) {
  if (fs::is_regular_file(typed)) return typed;
  const std::string folder = data_folder() + "/cases/campaigns",
                    shipped = folder + "/" + typed + campaign_ending;
  if (fs::is_regular_file(shipped)) return shipped;
  const std::vector<std::string> known = campaigns_in(folder), near = nearest_names(typed, known);
  throw InputError(fmt::format(
      "{}: there is no such campaign file, and no shipped campaign of that name; {}", typed,
      near.empty() ? fmt::format("shipped: {}", fmt::join(known, ", "))
                   : did_you_mean(near).substr(2)));
}

/// A case beside the campaign file, else one in the working folder, else a shipped one.
std::string case_of_campaign(const std::string& folder, const std::string& name) {
  for (const std::string& file : {folder + "/" + name, folder + "/" + name + ".toml"})
    if (fs::is_regular_file(file)) return fs::absolute(file).string();
  return fs::absolute(case_file(name)).string();
}

/// A first job that cannot be read would be refused a thousand times.
void reject_unreadable_case(OpenCampaign& of) {
  const std::vector<Assignment> first = job_assignments(of.campaign, 0);
  if (of.campaign.run == "simulate" && of.keys.case_file_of(first).empty())
    throw InputError(of.campaign.file + ": needs the key 'case', a case file or a shipped case");
  static_cast<void>(of.keys.key_of(first));
}

bool is_live(const Batch& batch) {
  return FileLock::is_held(lock_of_slice(batch, 0)) ||
         (batch.engine == "slurm" && slurm_has(batch));
}

std::set<std::string> keys_in(const std::vector<Batch>& batches) {
  std::set<std::string> keys;
  for (const Batch& batch : batches)
    for (size_t slice = 0; slice < batch.slices; ++slice)
      for (const BatchJob& job : read_slice(batch, slice)) keys.insert(job.key);
  return keys;
}

/// Whether a result answers what the campaign asks: frames that it wants may be missing.
bool answers(const OpenCampaign& of, const JobResult& result) {
  if (of.campaign.run != "simulate" || !result.kept.empty()) return true;
  return of.campaign.keep == Keep::none ||
         (of.campaign.keep == Keep::failures && result.end == JobEnd::holds);
}

}  // namespace

OpenCampaign open_campaign(const std::string& file, const std::string& out) {
  const std::string path = campaign_file(file);
  Campaign campaign = read_campaign(path);
  const std::vector<std::string> known = campaign_commands();
  if (std::ranges::count(known, campaign.run) == 0)
    throw InputError(fmt::format("{}: run = \"{}\" is no command of a campaign; known: {}", path,
                                 campaign.run, fmt::join(known, ", ")));
  const std::string beside = fs::absolute(path).parent_path().string();
  const std::string program = program_digest();
  const std::string store = fs::absolute(out + "/store").string();
  JobKeys keys(campaign, program + script_digest(campaign.run),
               [beside](const std::string& name) { return case_of_campaign(beside, name); });
  const std::string folder = out + "/campaigns/" + campaign.name;
  const std::vector<std::string> varied = varied_parameters(campaign);
  OpenCampaign of{std::move(campaign), folder,          store, program,
                  std::move(keys),     JobIndex(store), varied};
  reject_unreadable_case(of);
  of.index.merge();
  return of;
}

BatchTerms OpenCampaign::terms() const {
  return {store,         campaign.name,   campaign.run, campaign.quantities,
          campaign.keep, campaign.limits, program};
}

BatchJob batch_job(OpenCampaign& of, size_t i) {
  BatchJob job;
  job.set = job_assignments(of.campaign, i);
  job.key = of.keys.key_of(job.set);
  for (const Assignment& a : job.set)
    if (std::ranges::binary_search(of.varied, a.key))
      job.label += (job.label.empty() ? "" : " ") + a.key + "=" + a.value;
  if (job.label.empty()) job.label = of.campaign.name;
  const std::string file = of.keys.case_file_of(job.set);
  for (Assignment& a : job.set)
    if (a.key == "case") a.value = file;
  return job;
}

size_t Standing::done() const {
  size_t all = 0;
  for (const auto& [end, count] : ended) all += count;
  return all;
}

std::vector<Batch> live_batches(const std::string& store) {
  std::vector<Batch> live;
  for (const Batch& batch : open_batches(store)) {
    if (!is_live(batch))
      mark_ended(batch);
    else
      live.push_back(batch);
  }
  return live;
}

Standing stand(OpenCampaign& of, const std::function<void(const BatchJob&)>& take_missing) {
  Standing standing;
  const std::set<std::string> elsewhere = keys_in(live_batches(of.store));
  of.index.merge();  // after batches were asked: what ended since then is in their shards
  const std::map<std::string, int> starts = of.index.open_starts();
  std::set<std::string> asked;  // a job may be stated twice
  const SqliteTransaction reading = of.index.reading();
  for (size_t i = 0; i < of.campaign.root.jobs; ++i) {
    const std::string key = of.keys.key_of(job_assignments(of.campaign, i));
    const std::optional<JobResult> result = of.index.find(key);
    if (result && answers(of, *result)) {
      ++standing.ended[result->end];
      if (result->end != JobEnd::holds)
        ++standing.reasons[{result->end, result->reason.substr(0, result->reason.find(" ("))}];
      standing.seconds += result->seconds;
      continue;
    }
    const auto started = starts.find(key);
    const int count = started == starts.end() ? 0 : started->second;
    if (elsewhere.contains(key)) {
      ++standing.elsewhere;
    } else if (count >= most_starts) {
      ++standing.crashed;
    } else {
      ++standing.missing;
      if (!take_missing || !asked.insert(key).second) continue;
      BatchJob job = batch_job(of, i);
      job.starts = count;
      take_missing(job);
    }
  }
  return standing;
}

}  // namespace foldproof
