// Runs checks, studies and cases on several cores.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "verification/files/results_file.h"

namespace foldproof {

/// A unit of work: independent of other jobs, with a result independent of their order.
struct Job {
  std::string name;  // of the check or the study; of a case "case." and its name
  double length;     // how long it takes beside others, roughly
  // records, studies and cases, to be added to those of the others
  std::function<RunRecord(const Progress&)> run;
  int group = 0;  // jobs of a lower one are taken first
};

/// A record of this name that says nothing but that it did not run, or why it stopped.
Record unfinished_record(const std::string& name, std::optional<Outcome> outcome,
                         const std::string& note);

/// In which way jobs are run. No number that a job measures depends on it, seconds excepted.
struct JobSettings {
  unsigned threads = 0;  // jobs at a time; 0: one a core
  unsigned order = 0;   // 0: the longest of a group first; else shuffled, each number another order
  std::string keep_in;  // a folder for the results of each job until the run ends; "": none
  // use what an interrupted run of the same program, tier and seed left there
  bool resumes = false;
  bool restarts = false;  // delete it
};

/// As many as asked for, or else one a core.
int threads_of(const JobSettings& running);

class ProgressLine;

/// Where jobs stand in a longer work, in the unit of their lengths.
struct ProgressSpan {
  ProgressLine& line;
  double before;  // of the work, done
  double whole;   // > 0
};

/// Runs the jobs; says a line about each finding that does not hold, and adds what they made
/// to the run in the order of the list. A job that throws becomes a finding of its name that
/// fails and says why.
void run_jobs(const std::vector<Job>& jobs, const std::string& label, const JobSettings& settings,
              RunRecord& run);

/// As above; shows its progress as a part of a longer work.
void run_jobs(const std::vector<Job>& jobs, const ProgressSpan& span, const JobSettings& settings,
              RunRecord& run);

}  // namespace foldproof
