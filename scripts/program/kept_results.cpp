#include "scripts/program/kept_results.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "convergence/campaigns/wide_key.h"
#include "reference/types.h"
#include "scripts/program/progress.h"
#include "scripts/program/provenance.h"
#include "verification/files/part_file.h"

namespace foldproof {

namespace {

namespace fs = std::filesystem;

fs::path place_of(const std::string& folder) { return fs::path(folder) / "unfinished"; }

std::string file_of(const std::string& place, const std::string& job) {
  WideKey key;
  key.add(job);
  return (fs::path(place) / (key.text() + ".cbor")).string();
}

/// Kept results without the frames of their case are of no use.
bool has_its_files(const RunRecord& part, const std::string& place) {
  return std::ranges::all_of(part.cases, [&](const CaseRecord& record) {
    return record.file.empty() || fs::exists(fs::path(place).parent_path() / record.file);
  });
}

}  // namespace

KeptResults::KeptResults(const JobSettings& settings, const RunRecord& run)
    : resumes_(settings.resumes), tier_(run.tier), seed_(run.seed) {
  if (settings.keep_in.empty()) return;
  const fs::path place = place_of(settings.keep_in);
  if (settings.restarts) fs::remove_all(place);
  if (!resumes_ && fs::exists(place) && !fs::is_empty(place))
    throw InputError(fmt::format(
        "{}: results of an interrupted run; --resume goes on with them, --restart deletes them",
        place.string()));
  fs::create_directories(place);
  folder_ = place.string();
  program_ = program_digest();
  now_ = {run.provenance.commit, run.provenance.tree, run.provenance.date, 1};
}

std::vector<Job> KeptResults::wrapped(const std::vector<Job>& jobs) {
  if (folder_.empty()) return jobs;
  std::vector<Job> all = jobs;
  for (Job& job : all)
    job.run = [this, inner = job](const Progress& progress) {
      return found_or_run(inner, progress);
    };
  return all;
}

RunRecord KeptResults::found_or_run(const Job& job, const Progress& progress) {
  if (std::optional<RunRecord> part = found(job.name)) return *std::move(part);
  RunRecord part = job.run(progress);
  keep(job.name, part);
  return part;
}

std::optional<RunRecord> KeptResults::found(const std::string& job) {
  if (folder_.empty() || !resumes_) return {};
  std::optional<RunRecord> part = read_part(file_of(folder_, job), {job, program_, tier_, seed_});
  if (!part || !has_its_files(*part, folder_)) return {};
  count(part->origins.front(), true);
  return part;
}

void KeptResults::keep(const std::string& job, const RunRecord& part) {
  if (folder_.empty()) return;
  write_part(file_of(folder_, job), {job, program_, tier_, seed_}, now_, part);
  count(now_, false);
}

void KeptResults::count(const RunOrigin& origin, bool is_kept) {
  const std::lock_guard held(mutex_);
  went_on_ |= is_kept;
  const auto known = std::ranges::find_if(origins_, [&](const RunOrigin& one) {
    return std::pair(one.commit, one.date) == std::pair(origin.commit, origin.date);
  });
  if (known == origins_.end())
    origins_.push_back(origin);
  else
    ++known->jobs;
}

void KeptResults::name_origins(RunRecord& run) const {
  if (!went_on_) return;
  run.origins = origins_;
  std::ranges::sort(run.origins, {}, &RunOrigin::date);
  log_line(fmt::format("of an interrupted run that went on: {}", origins_text(run)));
}

void drop_kept_results(const std::string& folder) {
  std::error_code unheeded;
  fs::remove_all(place_of(folder), unheeded);
}

}  // namespace foldproof
