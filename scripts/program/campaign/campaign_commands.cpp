// foldproof campaign plan, table, report and status.
#include "scripts/program/campaign/campaign_commands.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <thread>

#include "convergence/any_case/ladder_cost.h"
#include "scripts/program/campaign/campaign_table.h"
#include "scripts/program/campaign/run_job.h"
#include "scripts/program/campaign/standing.h"
#include "scripts/program/listing.h"
#include "scripts/program/pages/report_script.h"
#include "scripts/program/run_all.h"
#include "scripts/program/run_case.h"
#include "verification/files/atomic_file.h"
#include "verification/files/level_set_folder.h"

namespace foldproof {

namespace {

namespace fs = std::filesystem;

struct Forecast {
  double seconds = 0, bytes = 0;  // a job
  double longest = 0;             // of the sampled jobs [s]
  std::string sampled;            // what was run, for the reader
};

/// Runs the first, middle and last job here and now, without keeping anything.
Forecast sample_three(OpenCampaign& of) {
  const Campaign& c = of.campaign;
  BatchTerms terms = of.terms();
  terms.keep = Keep::none;
  const LevelSetProvider level_sets = memoizing_provider(computing_provider());
  Forecast forecast;
  const std::set<size_t> chosen = {0, c.root.jobs / 2, c.root.jobs - 1};
  for (const size_t i : chosen) {
    const BatchJob job = batch_job(of, i);
    const JobResult result = run_job(terms, job, level_sets).result;
    forecast.seconds += result.seconds / double(chosen.size());
    forecast.longest = std::max(forecast.longest, result.seconds);
    forecast.bytes += double(result_line(job.key, result).size() + 1) / double(chosen.size());
    forecast.sampled +=
        fmt::format("  {}: {}, {:.3g} s\n", job.label, name_of(result.end), result.seconds);
  }
  return forecast;
}

std::string forecast_text(const Forecast& forecast, size_t jobs) {
  const double all = forecast.seconds * double(jobs);
  const unsigned here = std::max(1u, std::thread::hardware_concurrency());
  const auto on = [&](unsigned cores) {  // no sooner than the longest job
    return duration_text(std::max(all / cores, forecast.longest));
  };
  return fmt::format(
      "sample:\n{}forecast: {} of one core, {} on the {} here, {} on 100 nodes of 32 without the "
      "queue; {:.3g} MB of results, without files that are kept\n",
      forecast.sampled, duration_text(all), on(here), here, on(3200),
      forecast.bytes * double(jobs) / 1e6);
}

void write_tables(const OpenCampaign& of, const CampaignTable& table,
                  const std::vector<Record>& verdicts) {
  fs::create_directories(of.folder);
  write_text(of.folder + "/table.csv", csv_of(table));
  write_hdf5_table(of.folder + "/table.h5", table);
  write_text(of.folder + "/campaign.json", json_of_table(of.campaign, table, verdicts));
}

int exit_code_of(const std::vector<Record>& verdicts) {
  for (const Record& record : verdicts)
    if (record.outcome != Outcome::holds) return some_fail;
  return all_hold;
}

}  // namespace

int plan_campaign(const Options& options) {
  OpenCampaign of = open_campaign(options.file, options.out);
  const Standing standing = stand(of);
  fmt::print("{}", standing_text(of, standing));
  if (standing.missing == 0) return all_hold;
  fmt::print("{}", forecast_text(sample_three(of), standing.missing));
  return all_hold;
}

int show_campaign_table(const Options& options) {
  OpenCampaign of = open_campaign(options.file, options.out);
  const CampaignTable table = campaign_table(of);
  const std::vector<Record> verdicts = judge_campaign(of.campaign, table);
  write_tables(of, table, verdicts);
  RunRecord judged;
  judged.records = verdicts;
  if (options.json)
    fmt::print("{}\n", json_of_table(of.campaign, table, verdicts));
  else
    fmt::print("{}{}{}/table.csv: {} rows, also table.h5\n", listing(judged),
               text_of(sensitivities_of(of.campaign, table)), of.folder, table.keys.size());
  return exit_code_of(verdicts);
}

int report_campaign(const Options& options) {
  OpenCampaign of = open_campaign(options.file, options.out);
  const CampaignTable table = campaign_table(of);
  write_tables(of, table, judge_campaign(of.campaign, table));
  return run_report_script("report", "make_campaign.py", {of.folder});
}

int show_campaign_status(const Options& options) {
  OpenCampaign of = open_campaign(options.file, options.out);
  const Standing standing = stand(of);
  fmt::print("{}", options.json ? standing_json(of, standing) : standing_text(of, standing));
  if (standing.missing + standing.elsewhere > 0) return some_fail;
  return all_hold;
}

}  // namespace foldproof
