// foldproof check, study, verify: the suite, or parts of it.

#include <chrono>

#include "convergence/studies.h"
#include "reference/bodies/level_set_provider.h"
#include "scripts/program/bench/bench.h"
#include "scripts/program/data_folder.h"
#include "scripts/program/interruption.h"
#include "scripts/program/kept_results.h"
#include "scripts/program/ledger.h"
#include "scripts/program/command_line/options_of_commands.h"
#include "scripts/program/command_line/out_folder.h"
#include "scripts/program/command_line/typed_words.h"
#include "scripts/program/listing.h"
#include "scripts/program/progress.h"
#include "scripts/program/provenance.h"
#include "scripts/program/pages/report_script.h"
#include "scripts/program/run_all.h"
#include "scripts/program/run_case.h"
#include "verification/checks.h"
#include "verification/claims/read_claims.h"
#include "verification/faults/faults.h"
#include "verification/seeds.h"
#include "verification/files/verdicts_file.h"
#include "verification/subjects/reference_subject.h"

namespace foldproof {

namespace {

std::vector<Claim> written_claims() { return read_claims(data_folder() + "/verification/claims"); }

std::string faults_folder() { return data_folder() + "/verification/faults"; }

RunRecord new_run(const Options& options) {
  RunRecord run;
  run.provenance = provenance(options.command);
  run.tier = options.tier;
  const Subject subject = reference_subject();
  seed_shift = options.seed_shift;
  run.seed = options.seed_shift;
  if (seed_shift > 0)
    log_line(fmt::format("the seeds of all samples are shifted by {}", seed_shift));
  run.subject = subject.name;
  run.subject_version = subject.version;
  return run;
}

/// In the folder of the run its results are kept until it ends.
JobSettings running_of(const Options& options) {
  JobSettings running = options.running;
  running.keep_in = options.out;
  running.resumes = options.resumes;
  running.restarts = options.restarts;
  return running;
}

void require_folder_to_resume(const Options& options) {
  if (options.out.empty() && (options.resumes || options.restarts))
    throw InputError("--resume and --restart need --out, the folder of the interrupted run");
}

/// For a run of checks, studies and cases.
InterruptionNotice kept_results_notice(const Options& options) {
  if (options.out.empty()) return {"nothing is kept without --out DIR", ""};
  return {"finished results are kept in " + options.out + "/unfinished",
          with_option(options.words, "--resume")};
}

/// Names the faults, writes the files that were asked for, prints, and gives the exit code.
int conclude(RunRecord& run, const Options& options, const std::string& file) {
  run.faults = read_faults(faults_folder());
  name_faults(run.faults, run.records);
  if (!file.empty()) {
    write_run(options.out + "/" + file, run);
    write_verdicts(options.out, run);
    drop_kept_results(options.out);
  }
  if (options.json)
    fmt::print("{}", verdicts_json(run));
  else
    fmt::print("{}{}\n", listing(run), summary(run));
  return exit_code(run);
}

/// Judges all shipped cases; those that are shown leave their files in the folder.
std::vector<Job> jobs_of_built_in_cases(const Options& options, const Provenance& provenance) {
  constexpr double length = 60;
  const LevelSetProvider provider = provider_for(options.cache, 1);
  std::vector<Job> jobs;
  for (const std::string& name : hard_cases())
    jobs.push_back({"case." + name, length, [name](const Progress& progress) {
                      RunRecord part;
                      const BuiltCase of = built_case(built_in_case(name), computing_provider());
                      part.records = judge_case(of, progress);
                      return part;
                    }});
  for (const std::string& name : shown_cases(tier_of(options)))
    jobs.push_back({"case." + name, length,
                    [name, provider, folder = options.out, provenance](const Progress& progress) {
                      CaseRun done = run_case(built_case(built_in_case(name), provider), folder,
                                              provenance, progress);
                      RunRecord part;
                      part.cases = {done.record};
                      part.records = std::move(done.findings);
                      return part;
                    }});
  return jobs;
}

/// Writes verdicts of a run that has not ended, so that one which never does is not taken for
/// the one before.
void announce(const std::vector<Job>& jobs, RunRecord begun, const std::string& folder) {
  for (const Job& job : jobs)
    begun.records.push_back(unfinished_record(job.name, std::nullopt, "the run has not finished"));
  write_verdicts(folder, begun);
}

/// Runs all checks, studies and cases of the tier, rules the claims, and writes what came of it.
RunRecord run_whole_suite(const Options& options) {
  const std::vector<Claim> claims = written_claims();
  RunRecord run = new_run(options);
  const InterruptionNotice notice = kept_results_notice(options);
  const auto start = std::chrono::steady_clock::now();
  const Subject subject = reference_subject();
  std::vector<Job> jobs =
      jobs_of(select({{}, {"check", "study"}}, tier_of(options)), subject, tier_of(options));
  for (Job& job : jobs_of_built_in_cases(options, run.provenance)) jobs.push_back(std::move(job));
  announce(jobs, run, options.out);
  run_jobs(jobs, "checks, studies and cases", running_of(options), run);
  run.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  rule_all_claims(claims, run);
  run.faults = read_faults(faults_folder());
  reject_faults_of_lost_findings(run.faults, run);
  name_faults(run.faults, run.records);
  write_run(options.out + "/run.h5", run);
  write_verdicts(options.out, run);
  drop_kept_results(options.out);
  return run;
}

/// Runs everything of one kind, or what is named of it.
int run_kind(const std::string& kind, const Options& options) {
  require_folder_to_resume(options);
  const OutFolder folder(options.out);
  const std::vector<Claim> claims = written_claims();
  RunRecord run = new_run(options);
  const InterruptionNotice notice = kept_results_notice(options);
  const Tier tier = tier_of(options);
  run_selection(select({options.names, {kind}}, tier), reference_subject(), tier,
                running_of(options), run);
  if (kind == "study" && options.names.empty()) {
    reject_claims_of_lost_findings(claims, run);
    reject_faults_of_lost_findings(read_faults(faults_folder()), run);
  }
  rule_covered_claims(claims, run);
  return conclude(run, options, options.out.empty() ? "" : "run.h5");
}

int run_checks(const Options& options) { return run_kind("check", options); }
int run_studies(const Options& options) { return run_kind("study", options); }

struct VerifyOptions : Options {
  bool no_report = false, no_bench = false;
};

int verify(const VerifyOptions& options) {
  const OutFolder folder(options.out);
  const RunRecord run = run_whole_suite(options);
  const InterruptionNotice notice(
      "the findings are kept in " + options.out,
      options.no_report ? "" : program_command() + " report " + shell_word(options.out));
  if (!options.no_bench) {
    RunRecord speeds = bench(tier_of(options) == Tier::full ? 1'100'000 : 110'000);
    speeds.provenance = run.provenance;
    write_run(options.out + "/bench.h5", speeds);
  }
  const int reported =
      options.no_report ? all_hold : run_report_script("report", "make_report.py", {options.out});
  if (options.json)
    fmt::print("{}", verdicts_json(run));
  else
    fmt::print("{} ({:.0f} s)\n", summary(run), run.seconds);
  return reported != all_hold ? reported : exit_code(run);
}

/// check and study: they write files only if a folder is named.
void add_selection(CLI::App& app, Program& program, const CommandText& text,
                   int (*run)(const Options&)) {
  auto [command, options] = add_command(app, program, text, run);
  command->add_option("NAME", options.names,
                      "Names or groups, as `foldproof list checks` shows them");
  add_out_if_typed(command, options,
                   "Also write run.h5, verdicts.json and junit.xml into this folder");
  add_running(command, options);
  add_tier(command, options);
  add_json(command, options);
}

constexpr const char* below_check =
    R"(Examples:
  foldproof check bending                              all checks of bending
  foldproof check case.hinge --json                    what is expected of a shipped case

Exit codes:
  0    everything holds
  1    something fails or is inconclusive
  2    bad input; a name matches nothing)";

constexpr const char* below_study =
    R"(Examples:
  foldproof study time-order.hinge
  foldproof study work-precision --tier full --out mine

Exit codes:
  0    everything holds
  1    something fails or is inconclusive
  2    bad input; a name matches nothing)";

constexpr const char* below_verify =
    R"(Results are kept in DIR/unfinished as they come, and deleted at the end. A run that was interrupted
goes on with --resume, if program, tier and seed are the same; the report names the commits.

Examples:
  foldproof verify
  foldproof verify --tier full --out full --resume     hours, also in parts

Exit codes:
  0    everything holds, and the ruling on every claim is as recorded
  1    something fails or is inconclusive, or more than 5 % of the bounds are empirical
  2    bad input, or a file that cannot be written)";

}  // namespace

void add_verify_command(CLI::App& app, Program& program) {
  add_selection(app, program, {"check", "Run checks (all, or those named)", below_check},
                run_checks);
  add_selection(app, program, {"study", "Run studies (all, or those named)", below_study},
                run_studies);
  auto [everything, options] = add_command(
      app, program,
      {"verify", "Run all checks, studies and cases; give rulings on claims, write the report",
       below_verify},
      verify);
  add_switch(everything, "--no-report", options.no_report, "Write the results only");
  add_switch(everything, "--no-bench", options.no_bench, "Do not measure speed");
  add_running(everything, options);
  add_tier(everything, options);
  add_cache(everything, options);
  add_folder(everything, options, "Folder for results")->capture_default_str();
  add_json(everything, options);
}

}  // namespace foldproof
