#include "scripts/program/run_all.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "convergence/studies.h"
#include "scripts/program/progress.h"
#include "scripts/program/run_case.h"
#include "scripts/program/command_line/suggestions.h"
#include "verification/finding_kinds.h"
#include "verification/checks.h"

namespace foldproof {

namespace {

/// The findings of a shipped case are named so: "case.twist" for "hard/twist".
std::string group_of_case(const std::string& built_in) {
  return "case." + std::filesystem::path(built_in).filename().string();
}

bool is_named(const std::vector<std::string>& kinds, const char* kind) {
  return std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
}

[[noreturn]] void reject(const std::string& name, const std::vector<Check>& checks,
                         const std::vector<Study>& studies) {
  std::vector<std::string> known;
  const auto add = [&](const std::string& full) {
    known.insert(known.end(), {full, full.substr(0, full.find('.'))});
  };
  for (const Check& check : checks) add(check.name);
  for (const Study& study : studies) add(study.name);
  for (const std::string& file : built_in_cases(Tier::full)) add(group_of_case(file));
  throw InputError(fmt::format("there is no check, study or case '{}' (see `foldproof list`){}",
                               name, did_you_mean(nearest_names(name, known))));
}

bool add_named(const std::string& name, const std::vector<Check>& checks,
               const std::vector<Study>& studies, Selection& selection) {
  bool found = false;
  for (const Check& check : checks)
    if (chooses(name, check.name)) {
      selection.checks.push_back(check);
      found = true;
    }
  for (const Study& study : studies) {
    const bool is_finding = name.starts_with(study.name + ".");
    if (!is_finding && !chooses(name, study.name)) continue;
    if (is_finding) selection.findings.push_back(name);
    const auto same = [&](const Study& other) { return other.name == study.name; };
    if (std::none_of(selection.studies.begin(), selection.studies.end(), same))
      selection.studies.push_back(study);
    found = true;
  }
  return found;
}

/// Adds the shipped cases that "case" (those of the tier), "case.NAME" or
/// "case.NAME.FINDING" chooses.
bool add_cases(const std::string& name, Tier tier, Selection& selection) {
  bool found = false;
  for (const std::string& built_in : built_in_cases(name == "case" ? tier : Tier::full)) {
    const std::string group = group_of_case(built_in);
    const bool is_finding = name.starts_with(group + ".");
    if (!is_finding && !chooses(name, group)) continue;
    if (is_finding) selection.findings.push_back(name);
    const auto same = [&](const Case& other) { return "case." + other.scene.name == group; };
    if (std::none_of(selection.cases.begin(), selection.cases.end(), same))
      selection.cases.push_back(built_in_case(built_in));
    found = true;
  }
  return found;
}

/// Of the records those that are wanted: all, if none is named, and always that of `name` itself.
std::vector<Record> select_records(std::vector<Record> records,
                                   const std::vector<std::string>& wanted,
                                   const std::string& name) {
  std::erase_if(records, [&](const Record& record) {
    const auto chosen = [&](const std::string& one) { return chooses(one, record.name); };
    return !wanted.empty() && record.name != name && std::ranges::none_of(wanted, chosen);
  });
  return records;
}

Job job_of(const Check& check, const Subject& subject) {
  return {check.name, 1, [check, &subject](const Progress&) {
            RunRecord part;
            part.records = {run_check(check, subject)};
            return part;
          }};
}

Job job_of(const Study& study, const Subject& subject, Tier tier,
           const std::vector<std::string>& wanted) {
  return {study.name, 30, [study, &subject, tier, wanted](const Progress& progress) {
            auto [records, whole] = run_study(study, subject, tier, progress);
            RunRecord part;
            part.records = select_records(std::move(records), wanted, study.name);
            part.studies = {std::move(whole)};
            return part;
          }};
}

Job job_of(const Case& input_case, const std::vector<std::string>& wanted) {
  return {"case." + input_case.scene.name, 60, [input_case, wanted](const Progress& progress) {
            RunRecord part;
            part.records = select_records(
                judge_case(built_case(input_case, computing_provider()), progress), wanted, "");
            return part;
          }};
}

/// Throws InputError for the name of checks or cases where a study is expected.
void reject_other_kind(const std::string& name, const std::vector<Check>& checks, Tier tier) {
  Selection others;
  if (add_named(name, checks, {}, others) || add_cases(name, tier, others))
    throw InputError(
        fmt::format("'{0}' names checks or cases, and no study; type `foldproof check {0}`", name));
}

}  // namespace

bool chooses(const std::string& wanted, const std::string& name) {
  return name == wanted || name.starts_with(wanted + ".");
}

Selection select(const NameFilter& wanted, Tier tier) {
  const std::vector<Check> checks = all_checks();
  const std::vector<Study> studies = all_studies();
  Selection selection;
  if (wanted.names.empty()) {
    if (is_named(wanted.kinds, "check")) selection.checks = checks;
    if (is_named(wanted.kinds, "study")) selection.studies = studies;
  }
  const bool only_studies = !wanted.names.empty() && !is_named(wanted.kinds, "check");
  for (const std::string& name : wanted.names) {
    if (only_studies
            ? add_named(name, {}, studies, selection)
            : add_named(name, checks, studies, selection) || add_cases(name, tier, selection))
      continue;
    if (only_studies) reject_other_kind(name, checks, tier);
    reject(name, checks, studies);
  }
  return selection;
}

std::vector<Job> jobs_of(const Selection& selection, const Subject& subject, Tier tier) {
  std::vector<Job> jobs;
  for (const Check& check : selection.checks) jobs.push_back(job_of(check, subject));
  for (const Study& study : selection.studies)
    jobs.push_back(job_of(study, subject, tier, selection.findings));
  for (const Case& input_case : selection.cases)
    jobs.push_back(job_of(input_case, selection.findings));
  return jobs;
}

void run_selection(const Selection& selection, const Subject& subject, Tier tier,
                   const JobSettings& settings, RunRecord& run) {
  run_jobs(jobs_of(selection, subject, tier),
           selection.studies.empty() ? "checks" : "checks and studies", settings, run);
  for (const std::string& name : selection.findings)
    if (std::none_of(run.records.begin(), run.records.end(), [&](const Record& r) {
          return chooses(name, r.name) || r.outcome == Outcome::fails;
        }))
      throw InputError(
          fmt::format("there is no finding '{}'; `foldproof check {}` shows those there are", name,
                      name.substr(0, name.rfind('.'))));
}

std::string summary(const RunRecord& run) {
  const auto count = [&](Outcome outcome) {
    return std::count_if(run.records.begin(), run.records.end(),
                         [&](const Record& r) { return r.outcome == outcome; });
  };
  const auto claims = [&](Outcome outcome) {
    return std::count_if(run.claims.begin(), run.claims.end(),
                         [&](const ClaimRecord& c) { return outcome_of(c) == outcome; });
  };
  const auto generic = std::count_if(run.records.begin(), run.records.end(), [](const Record& r) {
    return r.outcome == Outcome::holds && scope_of(r) == FindingScope::generic;
  });
  const auto unrun = std::ranges::count_if(run.records, did_not_run);
  const std::string of_them =
      generic > 0 ? fmt::format(" ({} that every case makes)", generic) : "";
  std::string findings = fmt::format("{} hold{}, {} fail, {} inconclusive, {} not applicable",
                                     count(Outcome::holds), of_them, count(Outcome::fails),
                                     count(Outcome::inconclusive), count(Outcome::not_applicable));
  if (unrun > 0) findings += fmt::format(", {} did not run", unrun);
  if (run.claims.empty()) return findings;
  const auto waiting = std::ranges::count_if(run.claims, waits_for_full_tier);
  const std::string ruled =
      findings +
      fmt::format("; {} claims ruled as recorded, {} against the record, {} undecided{}",
                  claims(Outcome::holds), claims(Outcome::fails), claims(Outcome::inconclusive),
                  waiting > 0 ? fmt::format(" ({} until the full tier has run)", waiting) : "");
  if (!has_too_many_empirical_bounds(run)) return ruled;
  return ruled + fmt::format("; {:.1f} % of the bounds are empirical, more than {:.0f} %",
                             100 * empirical_share(run.records), 100 * most_empirical);
}

bool has_too_many_empirical_bounds(const RunRecord& run) {
  return !run.claims.empty() && empirical_share(run.records) > most_empirical;
}

int exit_code(const RunRecord& run) {
  const auto is_bad = [](const Record& r) {
    return r.outcome == Outcome::fails || r.outcome == Outcome::inconclusive || did_not_run(r);
  };
  const auto is_wrong = [&](const ClaimRecord& c) {
    return outcome_of(c) == Outcome::fails ||
           (outcome_of(c) == Outcome::inconclusive && !is_out_of_reach(c) && run.tier == "full");
  };
  const bool passes = !has_too_many_empirical_bounds(run) &&
                      std::none_of(run.records.begin(), run.records.end(), is_bad) &&
                      std::none_of(run.claims.begin(), run.claims.end(), is_wrong);
  return passes ? 0 : 1;
}

}  // namespace foldproof
