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
  unsigned order = 0;  // 0: the longest of a group first; else shuffled, each number another order
};

/// Runs the jobs; says a line about each finding that does not hold, and adds what they made
/// to the run in the order of the list. A job that throws becomes a finding of its name that
/// fails and says why.
void run_jobs(const std::vector<Job>& jobs, const std::string& label, const JobSettings& settings,
              RunRecord& run);

}  // namespace foldproof
