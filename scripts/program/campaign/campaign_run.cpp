// foldproof campaign run, watch, work, emit and cancel.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <thread>

#include "scripts/program/campaign/campaign_commands.h"
#include "scripts/program/campaign/slurm.h"
#include "scripts/program/campaign/standing.h"
#include "scripts/program/campaign/work.h"
#include "scripts/program/command_line/typed_words.h"
#include "scripts/program/data_folder.h"
#include "scripts/program/interruption.h"
#include "scripts/program/progress.h"
#include "scripts/program/provenance.h"
#include "verification/files/atomic_file.h"

namespace foldproof {

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr size_t most_jobs_here = 100'000, most_jobs_in_slurm = 1'000'000;  // of a batch

WorkSettings work_settings(const Options& options) {
  const unsigned threads = unsigned(options.running.threads);
  return {int(threads > 0 ? threads : std::thread::hardware_concurrency()),
          options.cache.empty() ? "" : fs::absolute(options.cache).string()};
}

bool is_for_slurm(const Options& options) { return options.engine == "slurm"; }

/// Where a look takes long, looks are further apart. Throws Interrupted.
void pause_after_look(Clock::time_point look, Clock::duration least,
                      const InterruptionWatch& watch) {
  const auto now = Clock::now(), until = now + std::max(least, 4 * (now - look));
  for (; Clock::now() < until; watch.check())
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
}

/// Looks on until Slurm is done with the batch. `show` gets the number of jobs that ended.
void follow(OpenCampaign& of, const Batch& batch, const InterruptionWatch& watch,
            const std::function<void(size_t)>& show) {
  for (size_t ended = 0; slurm_has(batch);) {
    const auto look = Clock::now();
    ended += size_t(of.index.merge());
    show(std::min(ended, batch.jobs));
    pause_after_look(look, std::chrono::milliseconds(500), watch);
  }
}

/// Jobs a slice, and of a batch at most.
std::pair<size_t, size_t> sizes_for(const Standing& standing, const Options& options) {
  if (!is_for_slurm(options)) return {most_jobs_here, most_jobs_here};
  const size_t jobs = std::min(standing.missing, most_jobs_in_slurm);
  if (options.slice > 0)
    return {size_t(options.slice), std::min(jobs, size_t(options.slice) * slurm_most_slices())};
  const double seconds = standing.done() > 0 ? standing.seconds / double(standing.done()) : nan;
  return {slurm_jobs_a_slice(jobs, seconds, options.engine_options), jobs};
}

/// Takes what no other campaign's batch has, and runs it to its end. False if nothing is missing.
bool run_batch(OpenCampaign& of, const Options& options, const InterruptionWatch& watch,
               Standing& standing) {
  std::optional<FileLock> planning(std::in_place, lock_of_store(of.store), [&] { watch.check(); });
  standing = stand(of);
  if (standing.missing == 0) return false;
  const auto [slice, most] = sizes_for(standing, options);
  std::optional<BatchWriter> writer(std::in_place, of.terms(), options.engine, slice);
  stand(of, [&, most = most](const BatchJob& job) {
    if (writer->jobs() < most) writer->add(job);
  });
  const std::optional<Batch> finished = writer->finish();
  if (!finished) return true;  // since the first look another process ended the jobs: look again
  const Batch& batch = *finished;
  ProgressLine line(fmt::format("{} on {}: {} jobs", of.campaign.name, batch.engine, batch.jobs));
  const auto show = [&](size_t ended) {
    watch.check();
    line.show(double(ended) / double(batch.jobs));
  };
  try {
    if (is_for_slurm(options)) {
      writer.reset();  // a slice may start, and lock its file, before sbatch returns
      slurm_submit(batch, {options.engine_options, work_settings(options).cache, options.scratch});
    }
    planning.reset();
    if (!is_for_slurm(options))
      work_through(batch.terms, read_slice(batch, 0), work_settings(options),
                   new_shard_of_slice(batch, 0), show);
  } catch (...) {  // of what is not in a queue, others may take the jobs at once
    mark_ended(batch);
    throw;
  }
  if (is_for_slurm(options)) follow(of, batch, watch, show);
  mark_ended(batch);
  return true;
}

/// Batches of this campaign that a queue still has: an earlier call was interrupted.
void follow_earlier(OpenCampaign& of, const InterruptionWatch& watch) {
  for (const Batch& batch : live_batches(of.store)) {
    if (batch.terms.campaign != of.campaign.name || batch.engine != "slurm") continue;
    log_line(fmt::format("{} jobs are still with slurm; waiting for them", batch.jobs));
    follow(of, batch, watch, [](size_t) {});
  }
}

Standing run_batches(OpenCampaign& of, const Options& options) {
  const InterruptionWatch watch;
  follow_earlier(of, watch);
  for (Standing standing;; watch.check()) {
    if (run_batch(of, options, watch, standing)) continue;
    if (standing.elsewhere == 0) return standing;
    std::this_thread::sleep_for(std::chrono::milliseconds(500));  // another campaign has the rest
  }
}

int conclude_run(OpenCampaign& of, const Standing& standing) {
  fmt::print("{}", standing_text(of, standing));
  const auto held = standing.ended.find(JobEnd::holds);
  const bool all_held = held != standing.ended.end() && held->second == of.campaign.root.jobs;
  return all_held && of.index.conflicts().empty() ? all_hold : some_fail;
}

void say_what_to_type(const Options& options) {
  log_line(fmt::format("interrupted; go on with: {} campaign run {} --on {} --out {}",
                       program_command(), options.file, options.engine, options.out));
  if (is_for_slurm(options))
    log_line(fmt::format("its batch goes on in slurm; end it with: {} campaign cancel {} --out {}",
                         program_command(), options.file, options.out));
}

/// A shard on the node's own disk becomes the batch's, whole or not at all.
void bring_home(const std::string& scratch, const std::string& shard) {
  if (!fs::exists(scratch)) return;
  fs::create_directories(fs::path(shard).parent_path());
  fs::copy_file(scratch, shard + ".partial");
  fs::rename(shard + ".partial", shard);
  fs::remove(scratch);
}

/// Runs what the slice lacks. A scheduler that starts it again while it runs waits for the first.
bool work_on_slice(const Batch& batch, size_t slice, const Options& options) {
  const std::vector<BatchJob> jobs = read_slice(batch, slice);
  const InterruptionWatch watch;
  const FileLock lock(lock_of_slice(batch, slice), [&] { watch.check(); });
  std::vector<std::string> shards = shards_of_slice(batch, slice);
  const std::string shard = new_shard_of_slice(batch, slice),
                    scratch = options.scratch + "/" + fs::path(shard).filename().string();
  const auto home = [&] {
    if (!options.scratch.empty()) bring_home(scratch, shard);
  };
  try {
    work_through(batch.terms, missing_in(shards, jobs), work_settings(options),
                 options.scratch.empty() ? shard : scratch, [&](size_t) { watch.check(); });
  } catch (const Interrupted&) {
    home();
    throw;
  }
  home();
  shards.push_back(shard);
  return missing_in(shards, jobs).empty();
}

}  // namespace

int run_campaign(const Options& options) {
  if (!is_for_slurm(options) && options.engine != "local")
    throw InputError("--on " + options.engine + ": no such engine; known: local, slurm");
  if (const std::string why = slurm_missing(); is_for_slurm(options) && !why.empty())
    throw InputError("--on slurm: " + why);
  OpenCampaign of = open_campaign(options.file, options.out);
  try {
    return conclude_run(of, run_batches(of, options));
  } catch (const Interrupted& interrupted) {
    say_what_to_type(options);
    end_by(interrupted);
  }
}

int watch_campaign(const Options& options) {
  OpenCampaign of = open_campaign(options.file, options.out);
  const InterruptionWatch watch;
  const std::string page = of.folder + "/watch.html";
  fs::create_directories(of.folder);
  Standing standing = stand(of);
  const size_t done_before = standing.done();
  const auto start = Clock::now();
  try {
    while (standing.elsewhere > 0) {
      const auto look = Clock::now();
      // at the rate since the first look; not known while no job has ended
      const std::chrono::duration<double> seconds = look - start;
      const double ended = double(standing.done() - done_before),
                   left = ended > 0 ? double(standing.elsewhere) * seconds.count() / ended : nan;
      show_line(watch_line(of, standing, left));
      write_text(page, watch_page(of, standing, left));
      standing = stand(of);
      pause_after_look(look, std::chrono::seconds(2), watch);
    }
  } catch (const Interrupted& interrupted) {
    end_by(interrupted);
  }
  write_text(page, watch_page(of, standing, nan));
  end_line();
  fmt::print("{}", standing_text(of, standing));
  return standing.missing > 0 ? some_fail : all_hold;
}

int work_on_batch(const Options& options) {
  const Batch batch = read_batch(fs::absolute(options.file).lexically_normal().string());
  if (batch.terms.program != program_digest())
    throw InputError(options.file + ": was planned by another build of foldproof; plan it again");
  try {
    return work_on_slice(batch, size_t(options.slice), options) ? all_hold : some_fail;
  } catch (const Interrupted& interrupted) {
    end_by(interrupted);
  }
}

int emit_campaign(const Options& options) {
  OpenCampaign of = open_campaign(options.file, options.out);
  const FileLock planning(lock_of_store(of.store));
  BatchWriter writer(of.terms(), "emitted", options.slice > 0 ? size_t(options.slice) : 50);
  stand(of, [&](const BatchJob& job) { writer.add(job); });
  const std::optional<Batch> batch = writer.finish();
  if (!batch) {
    log_line("nothing is missing");
    return all_hold;
  }
  mark_ended(*batch);  // no one can say when it ends, so it keeps no one from its jobs
  for (size_t slice = 0; slice < batch->slices; ++slice)
    fmt::print("{}\n", with_option({program_file(), "campaign", "work", batch->folder, "--slice",
                                    std::to_string(slice), "--threads"},
                                   "1"));
  return all_hold;
}

int cancel_campaign(const Options& options) {
  const OpenCampaign of = open_campaign(options.file, options.out);
  size_t cancelled = 0;
  for (const Batch& batch : live_batches(of.store)) {
    if (batch.terms.campaign != of.campaign.name) continue;
    const size_t space = batch.writer.find(' ');
    if (batch.engine == "slurm")
      slurm_cancel(batch);
    else if (batch.writer.substr(0, space) == host_name())
      kill(pid_t(std::stol(batch.writer.substr(space))), SIGTERM);
    else
      throw InputError(batch.writer + ": runs this batch; cancel it there");
    ++cancelled;
  }
  fmt::print("{}: {} batches cancelled; `campaign run` goes on with what is missing\n",
             of.campaign.name, cancelled);
  return all_hold;
}

}  // namespace foldproof
