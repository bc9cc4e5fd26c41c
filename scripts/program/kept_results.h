// Results of jobs that outlive an interrupted run.
#pragma once

#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "scripts/program/jobs.h"

namespace foldproof {

/// Keeps what each job makes in files under `settings.keep_in` until drop_kept_results, so that a
/// run that is killed at any moment loses the jobs in progress only.
class KeptResults {
 public:
  /// run: its program, tier and seed. Does nothing if settings name no folder. Throws InputError if
  /// there are results of an interrupted run, and settings neither resume nor restart.
  KeptResults(const JobSettings& settings, const RunRecord& run);

  /// The jobs; each looks first for its own kept result. This object must outlive them.
  std::vector<Job> wrapped(const std::vector<Job>& jobs);

  /// The kept result of a job, if there is one and the settings resume.
  std::optional<RunRecord> found(const std::string& job);
  void keep(const std::string& job, const RunRecord& part);

  /// Adds to the run where its results come from, if some were kept by an earlier process.
  void name_origins(RunRecord& run) const;

 private:
  RunRecord found_or_run(const Job& job, const Progress& progress);
  void count(const RunOrigin& origin, bool is_kept);

  std::string folder_;  // "" for none
  bool resumes_;
  std::string program_, tier_;
  unsigned seed_;
  RunOrigin now_;
  std::mutex mutex_;
  bool went_on_ = false;  // some results are of an interrupted run
  std::vector<RunOrigin> origins_;
};

/// Deletes the results that jobs kept in the folder of a run: it has finished.
void drop_kept_results(const std::string& folder);

}  // namespace foldproof
