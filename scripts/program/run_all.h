// Running checks, studies and cases by name, and telling the world.
#pragma once

#include "scripts/program/jobs.h"
#include "verification/cases/expectations.h"
#include "convergence/study.h"
#include "verification/files/results_file.h"
#include "verification/subject.h"

namespace foldproof {

struct Selection {
  std::vector<Check> checks;
  std::vector<Study> studies;
  std::vector<Case> cases;
  // if not empty: only these of the studies' and cases' findings are wanted
  std::vector<std::string> findings;
};

/// Whether `wanted` is the name, or its group: "bending" for "bending.forces-sum-to-zero".
bool chooses(const std::string& wanted, const std::string& name);

/// Selection by name: checks, studies, single findings of studies, or groups ("bending" for all
/// that begins with "bending."), "case.NAME" for what is expected of a shipped case, whatever its
/// tier, and "case" for all shipped cases of the tier. No name: all of the kinds. Without "check"
/// among the kinds, names choose studies and their findings only. Throws InputError for a name that
/// chooses nothing, with the nearest known ones.
struct NameFilter {
  std::vector<std::string> names;
  std::vector<std::string> kinds;  // of "check", "study": chosen where no name is given
};
Selection select(const NameFilter& wanted, Tier tier);

/// A job for each check, study and case of the selection. The subject must outlive them.
std::vector<Job> jobs_of(const Selection& selection, const Subject& subject, Tier tier);

/// Runs the selection with progress, adds to the run, and says a line about each
/// that does not hold.
void run_selection(const Selection& selection, const Subject& subject, Tier tier,
                   const JobSettings& settings, RunRecord& run);

/// "121 hold, 0 fail, 0 inconclusive, 0 not applicable", how many did not run if any, and the
/// claims if any were ruled.
std::string summary(const RunRecord& run);

/// The run rules claims, so it is of the whole suite, and more of its bounds are empirical than
/// `most_empirical`.
bool has_too_many_empirical_bounds(const RunRecord& run);

/// 0 if every finding holds (or is not applicable, or measured only), every claim is ruled as
/// recorded and few bounds are empirical, else 1. A claim that is undecided, and recorded so, fails
/// the full tier only, unless it says what no run has.
int exit_code(const RunRecord& run);

}  // namespace foldproof
