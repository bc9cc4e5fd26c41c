#include "scripts/program/campaign/standing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <tuple>

#include "scripts/program/campaign/run_job.h"
#include "scripts/program/campaign/slurm.h"
#include "scripts/program/campaign/work.h"
#include "scripts/program/command_line/input_files.h"
#include "scripts/program/command_line/suggestions.h"
#include "scripts/program/data_folder.h"
#include "scripts/program/json_text.h"
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
bool answers(const Campaign& campaign, const JobResult& result) {
  const bool has_frames =
      result.end == JobEnd::holds || result.end == JobEnd::fails || result.end == JobEnd::stopped;
  const bool wants_frames = campaign.keep == Keep::all ||
                            (campaign.keep == Keep::failures && result.end != JobEnd::holds);
  return campaign.run != "simulate" || !has_frames || !wants_frames || !result.kept.empty();
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
    if (result && answers(of.campaign, *result)) {
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

// ---- in words -----------------------------------------------------------------------------------

namespace {

constexpr size_t most_reasons = 5;

/// End, words and count of what does not hold, the commonest first.
std::vector<std::tuple<std::string, std::string, size_t>> commonest_reasons(
    const Standing& standing) {
  std::vector<std::tuple<std::string, std::string, size_t>> reasons;
  for (const auto& [of, count] : standing.reasons)
    reasons.emplace_back(name_of(of.first), of.second, count);
  std::ranges::stable_sort(reasons, std::greater(), [](const auto& r) { return std::get<2>(r); });
  reasons.resize(std::min(reasons.size(), most_reasons));
  return reasons;
}

/// Counts that are not zero, each with its name.
std::vector<std::pair<std::string, size_t>> counts_of(const Standing& standing) {
  std::vector<std::pair<std::string, size_t>> counts;
  for (const auto& [end, count] : standing.ended) counts.emplace_back(name_of(end), count);
  for (const auto& [name, count] : {std::pair("crashed", standing.crashed),
                                    {"running", standing.elsewhere},
                                    {"missing", standing.missing}})
    if (count > 0) counts.emplace_back(name, count);
  return counts;
}

/// Processor hours of what runs and what is missing, at the mean of the jobs that ended.
std::string work_left(const Standing& standing) {
  const size_t left = standing.elsewhere + standing.missing;
  if (left == 0 || standing.done() == 0) return "";
  const double hours = standing.seconds / double(standing.done()) * double(left) / 3600;
  return fmt::format(", about {:.3g} hours of it left", hours);
}

std::string html(const std::string& text) {
  std::string escaped;
  for (const char c : text)
    escaped += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : std::string(1, c);
  return escaped;
}

}  // namespace

std::string standing_text(OpenCampaign& of, const Standing& standing) {
  std::string text = fmt::format("{}: {} jobs", of.campaign.name, of.campaign.root.jobs);
  for (const auto& [name, count] : counts_of(standing)) text += fmt::format(", {} {}", count, name);
  text += fmt::format("; {:.3g} s of processor time{}\n", standing.seconds, work_left(standing));
  for (const auto& [end, words, count] : commonest_reasons(standing))
    text += fmt::format("  {} {}: {}\n", count, end, words);
  const auto conflicts = of.index.conflicts();
  if (!conflicts.empty())
    text += fmt::format(
        "{} conflicts: a repetition found something else, as for {} in {}; table conflicts of "
        "{}/index.sqlite\n",
        conflicts.size(), conflicts[0].key, conflicts[0].shard, of.store);
  return text;
}

std::string standing_json(OpenCampaign& of, const Standing& standing) {
  using nlohmann::json;
  json ended = json::object(), reasons = json::array();
  for (const auto& [end, count] : standing.ended) ended[name_of(end)] = count;
  for (const auto& [end, words, count] : commonest_reasons(standing))
    reasons.push_back({{"outcome", end}, {"reason", words}, {"jobs", count}});
  return json_text({{"campaign", of.campaign.name},
                    {"jobs", of.campaign.root.jobs},
                    {"done", standing.done()},
                    {"ended", ended},
                    {"reasons", reasons},
                    {"crashed", standing.crashed},
                    {"running", standing.elsewhere},
                    {"missing", standing.missing},
                    {"seconds", standing.seconds},
                    {"repeated", of.index.repeated()},
                    {"conflicts", of.index.conflicts().size()}}) +
         "\n";
}

std::string watch_line(const OpenCampaign& of, const Standing& standing, double seconds_left) {
  std::string line =
      fmt::format("{}: {} of {} done", of.campaign.name, standing.done(), of.campaign.root.jobs);
  for (const auto& [name, count] : counts_of(standing))
    if (name != "holds") line += fmt::format(", {} {}", count, name);
  if (std::isnan(seconds_left)) return line;
  return line + (seconds_left < 90 ? fmt::format("; {:.0f} s left", seconds_left)
                                   : fmt::format("; {:.0f} min left", seconds_left / 60));
}

std::string watch_page(const OpenCampaign& of, const Standing& standing, double seconds_left) {
  const std::string title = html(of.campaign.title);
  std::string rows;
  for (const auto& [name, count] : counts_of(standing))
    rows += fmt::format("<tr><td>{}<td>{}<td>\n", html(name), count);
  for (const auto& [end, words, count] : commonest_reasons(standing))
    rows += fmt::format("<tr><td>{}<td>{}<td>{}\n", html(end), count, html(words));
  const size_t done = standing.done(), jobs = of.campaign.root.jobs;
  return fmt::format(
      "<!doctype html>\n<meta charset=\"utf-8\">{}\n<title>{} of {}: {}</title>\n"
      "<style>body{{font:16px/1.5 sans-serif;max-width:50em;margin:2em auto;padding:0 "
      "1em}}progress{{width:100%}}td{{padding:0 1em 0 "
      "0;vertical-align:top}}td:nth-child(2){{text-align:right}}</style>\n"
      "<h1>{}</h1>\n<progress value=\"{}\" max=\"{}\"></progress>\n<p>{}\n"
      "<table>\n{}</table>\n",
      standing.elsewhere > 0 ? "\n<meta http-equiv=\"refresh\" content=\"2\">" : "", done, jobs,
      title, title, done, jobs, html(watch_line(of, standing, seconds_left)), rows);
}

}  // namespace foldproof
