// Runs checks, studies and cases on all cores.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "verification/results_file.h"

namespace foldproof {

/// What is run by itself: it depends on no other job, and its result on no order.
struct Job {
  std::string name;  // of the check or the study; of a case "case." and its name
  double length;     // how long it takes beside others, roughly
  std::function<RunRecord(const Progress&)>
      run;  // records, studies and cases, to be added to those of the others
};

/// A record of this name that says nothing but that it did not run, or why it stopped.
Record unfinished(const std::string& name, const std::string& outcome, const std::string& note);

/// Runs the jobs, the longest first, one a core; says a line about each finding that does not hold, and adds what they
/// made to the run in the order of the jobs. A job that throws becomes a finding of its name that fails and says why.
void run_jobs(const std::vector<Job>& jobs, const std::string& label, RunRecord& run);

}  // namespace foldproof
