// foldproof campaign run, work and emit: rounds of what is missing, until nothing is.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <thread>

#include "scripts/program/campaign/campaign_commands.h"
#include "scripts/program/campaign/engine.h"
#include "scripts/program/campaign/slice_mark.h"
#include "scripts/program/campaign/standing.h"
#include "scripts/program/campaign/standing_text.h"
#include "scripts/program/data_folder.h"
#include "scripts/program/command_line/typed_words.h"
#include "scripts/program/interruption.h"
#include "scripts/program/progress.h"
#include "scripts/program/provenance.h"

namespace foldproof {

namespace {

namespace fs = std::filesystem;

constexpr std::chrono::milliseconds between_looks(500), between_checks(100);

EngineSettings engine_settings(const Options& options) {
  EngineSettings settings;
  const int cores = int(std::thread::hardware_concurrency());
  settings.work.processes = options.running.threads > 0 ? int(options.running.threads) : cores;
  settings.work.cache = options.cache.empty() ? "" : fs::absolute(options.cache).string();
  settings.options = options.engine_options;
  settings.scratch = options.scratch;
  return settings;
}

BatchTerms terms_of(const OpenCampaign& of) {
  const Campaign& c = of.campaign;
  return {of.store, c.name, c.run, c.quantities, c.keep, c.limits, of.program};
}

/// Of a job, by those that ended [s]; NaN before any has.
double mean_seconds(const Standing& standing) {
  return standing.done() > 0 ? standing.seconds / double(standing.done()) : nan;
}

/// Writes a batch of what is missing, so that no other campaign takes the same; none if nothing is.
std::optional<Batch> next_batch(OpenCampaign& of, const Engine& engine, const Options& options,
                                Standing& standing) {
  const StoreLock lock(of.store);
  standing = stand(of, {});
  if (standing.missing == 0) return {};
  const size_t jobs = std::min(standing.missing, engine.most_jobs);
  const size_t slice = options.slice > 0 ? size_t(options.slice)
                                         : engine.jobs_a_slice(jobs, mean_seconds(standing),
                                                               engine_settings(options));
  BatchWriter writer(terms_of(of), engine.name, slice);
  stand(of, [&](const BatchJob& job) {
    if (writer.jobs() < jobs) writer.add(job);
  });
  return writer.finish();
}

/// Looks on until the engine says that the batch is over; where a look takes long, less often.
void follow(OpenCampaign& of, const Batch& batch, const InterruptionWatch& watch,
            const std::function<void(size_t)>& show) {
  const Engine& engine = engine_named(batch.engine);
  for (size_t ended = 0; engine.ask(batch) != BatchState::has_ended;) {
    const auto start = std::chrono::steady_clock::now();
    ended += size_t(of.index.merge());
    show(std::min(ended, batch.jobs));
    const auto next = std::max<std::chrono::steady_clock::duration>(
        between_looks, 4 * (std::chrono::steady_clock::now() - start));
    for (const auto until = std::chrono::steady_clock::now() + next;
         std::chrono::steady_clock::now() < until; watch.check())
      std::this_thread::sleep_for(between_checks);
  }
}

void say_what_to_type(const Options& options, const Engine& engine) {
  log_line(fmt::format("interrupted; go on with: {} campaign run {} --on {} --out {}",
                       program_command(), options.file, engine.name, options.out));
  if (std::string(engine.name) != "local")
    log_line(fmt::format("its batch goes on in {}; end it with: {} campaign cancel {} --out {}",
                         engine.name, program_command(), options.file, options.out));
}

/// Runs one batch to its end.
void run_batch(OpenCampaign& of, Batch& batch, const Engine& engine, const Options& options,
               const InterruptionWatch& watch) {
  ProgressLine line(fmt::format("{} on {}: {} jobs", of.campaign.name, engine.name, batch.jobs));
  const auto show = [&](size_t ended) {
    watch.check();
    line.show(double(ended) / double(batch.jobs));
  };
  try {
    engine.submit(batch, engine_settings(options), show);
  } catch (...) {  // of what is not in a queue, others may take the jobs at once
    mark_ended(batch);
    throw;
  }
  if (std::string(engine.name) != "local") follow(of, batch, watch, show);
  mark_ended(batch);
}

int conclude_run(OpenCampaign& of, const Standing& standing) {
  fmt::print("{}", standing_text(of, standing));
  const bool all_there = standing.missing + standing.elsewhere + standing.crashed == 0;
  const auto held = standing.ended.find(JobEnd::holds);
  const bool all_held = held != standing.ended.end() && held->second == of.campaign.root.jobs;
  return all_there && all_held && of.index.conflicts().empty() ? all_hold : some_fail;
}

/// Batches of this campaign that a queue still has: an earlier call was interrupted.
void follow_earlier(OpenCampaign& of, const InterruptionWatch& watch) {
  for (const Batch& batch : live_batches(of.store)) {
    if (batch.terms.campaign != of.campaign.name || batch.engine == "local") continue;
    log_line(fmt::format("{} jobs are still with {}; waiting for them", batch.jobs, batch.engine));
    follow(of, batch, watch, [](size_t) {});
  }
}

Standing run_rounds(OpenCampaign& of, const Engine& engine, const Options& options) {
  const InterruptionWatch watch;
  follow_earlier(of, watch);
  Standing standing;
  for (;;) {
    watch.check();
    if (auto batch = next_batch(of, engine, options, standing))
      run_batch(of, *batch, engine, options, watch);
    else if (standing.elsewhere > 0)
      std::this_thread::sleep_for(between_looks);  // another campaign's batch has the rest
    else
      return standing;
  }
}

/// Shards that were written on the node's own disk become the batch's, each whole or not at all.
void bring_home(const std::string& scratch, const std::string& folder) {
  fs::create_directories(folder);
  for (const auto& entry : fs::directory_iterator(scratch)) {
    const std::string to = folder + "/" + entry.path().filename().string();
    fs::copy_file(entry.path(), to + ".partial");
    fs::rename(to + ".partial", to);
  }
  fs::remove_all(scratch);
}

int work_on_slice(const Batch& batch, size_t slice, const WorkSettings& work) {
  const InterruptionWatch watch;
  SliceMark mark(batch, slice, watch);
  const std::vector<BatchJob> missing =
      missing_in(shards_of_slice(batch, slice), read_slice(batch, slice));
  const auto home = [&] {
    if (!work.shards.empty()) bring_home(work.shards, shard_folder(batch, slice));
  };
  try {
    const auto show = [&](size_t) {
      watch.check();
      mark.renew();
    };
    const std::vector<std::string> shards = work_through(batch, slice, missing, work, show).shards;
    const bool is_done = missing_in(shards, missing).empty();
    home();
    return is_done ? all_hold : some_fail;
  } catch (const Interrupted&) {
    home();
    throw;
  }
}

}  // namespace

int run_campaign(const Options& options) {
  const Engine& engine = engine_named(options.engine);
  if (const std::string why = engine.missing(); !why.empty())
    throw InputError(fmt::format("--on {}: {}", engine.name, why));
  OpenCampaign of = open_campaign(options.file, options.out);
  try {
    return conclude_run(of, run_rounds(of, engine, options));
  } catch (const Interrupted& interrupted) {
    say_what_to_type(options, engine);
    end_by(interrupted);
  }
}

int work_on_batch(const Options& options) {
  const Batch batch = read_batch(fs::absolute(options.file).lexically_normal().string());
  if (batch.terms.program != program_digest())
    throw InputError(options.file + ": was planned by another build of foldproof; plan it again");
  WorkSettings work = engine_settings(options).work;
  if (!options.scratch.empty())
    work.shards = options.scratch + "/" + batch.name + "-" + new_shard_name();
  if (!work.shards.empty()) fs::create_directories(work.shards);
  try {
    return work_on_slice(batch, size_t(options.slice), work);
  } catch (const Interrupted& interrupted) {
    end_by(interrupted);
  }
}

int emit_campaign(const Options& options) {
  OpenCampaign of = open_campaign(options.file, options.out);
  const StoreLock lock(of.store);
  BatchWriter writer(terms_of(of), emitted, options.slice > 0 ? size_t(options.slice) : 50);
  stand(of, [&](const BatchJob& job) { writer.add(job); });
  const std::optional<Batch> written = writer.finish();
  if (!written) {
    log_line("nothing is missing");
    return all_hold;
  }
  const Batch& batch = *written;
  mark_ended(batch);  // no engine of ours can say when it ends, so it keeps no one from its jobs
  for (size_t slice = 0; slice < batch.slices; ++slice)
    fmt::print("{}\n", with_option({program_file(), "campaign", "work", batch.folder, "--slice",
                                    std::to_string(slice), "--threads"},
                                   "1"));
  return all_hold;
}

}  // namespace foldproof
