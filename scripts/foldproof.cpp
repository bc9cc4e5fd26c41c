// The program: what can be typed, and nothing else. See `foldproof --help`.
#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <sys/wait.h>

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "convergence/studies.h"
#include "scripts/program/bench.h"
#include "scripts/program/evaluate.h"
#include "scripts/program/progress.h"
#include "scripts/program/provenance.h"
#include "scripts/program/run_all.h"
#include "scripts/program/run_case.h"
#include "verification/all_checks.h"
#include "verification/faults_file.h"
#include "verification/verdicts_file.h"

namespace foldproof {
namespace {

constexpr int all_hold = 0, bad_input = 2;

struct Options {
  std::string command;  // as typed
  std::string out = "results", tier = "quick", file, rest_file;
  std::vector<std::string> names, overrides;
  bool json = false, quick = false, no_report = false;
};

Tier tier_of(const Options& options) { return options.tier == "full" ? Tier::full : Tier::quick; }

std::string faults_path() { return project_folder() + "/verification/faults.toml"; }

RunRecord new_run(const Options& options) {
  RunRecord run;
  run.provenance = provenance(options.command);
  run.tier = options.tier;
  const Subject subject = reference_subject();
  run.subject = subject.name;
  run.subject_version = subject.version;
  return run;
}

void make_folder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw InputError(folder + ": cannot make this folder: " + error.message());
}

std::vector<std::string> names_of_case_findings() {
  std::vector<std::string> names;
  for (const std::string& name : built_in_cases()) {
    const Case shown = built_in_case(name);
    for (const Expectation& expectation : shown.expectations)
      names.push_back(finding_name(shown.scene, expectation));
  }
  return names;
}

int list(const Options& options) {
  nlohmann::json json = {{"checks", nlohmann::json::array()}, {"studies", nlohmann::json::array()}};
  for (const Check& check : all_checks())
    json["checks"].push_back({{"name", check.name}, {"claim", check.claim}, {"source", check.source}});
  for (const Study& study : all_studies())
    json["studies"].push_back({{"name", study.name}, {"claim", study.claim}, {"source", study.source}});
  json["cases"] = built_in_cases();
  json["case_findings"] = names_of_case_findings();
  json["integrators"] = nlohmann::json::array();
  for (const Integrator& i : integrators())
    json["integrators"].push_back(
        {{"name", i.name}, {"title", i.title}, {"source", i.source}, {"order", i.order}});
  if (options.json) {
    fmt::print("{}\n", json.dump(1));
    return all_hold;
  }
  for (const char* kind : {"checks", "studies"}) {
    fmt::print("{}:\n", kind);
    for (const auto& row : json[kind])
      fmt::print("  {:<58} {}\n", row["name"].get<std::string>(), row["claim"].get<std::string>());
  }
  fmt::print("cases (cases/NAME.toml):\n");
  for (const std::string& name : built_in_cases()) fmt::print("  {}\n", name);
  fmt::print("integrators:\n");
  for (const Integrator& i : integrators())
    fmt::print("  {}  {} ({}), order {}\n", i.name, i.title, i.source, i.order);
  return all_hold;
}

nlohmann::json told(const CaseRun& run, const Options& options) {
  const Work& work = run.outcome.work;
  nlohmann::json json = {{"case", run.record.name},
                         {"file", options.out + "/" + run.record.file},
                         {"stopped", run.record.stopped},
                         {"steps", run.outcome.steps},
                         {"time", run.outcome.last.time},
                         {"seconds", run.record.seconds},
                         {"cg_iterations", work.cg_iterations},
                         {"solves", work.solves},
                         {"elastic_evaluations", work.elastic_evaluations},
                         {"unfinished_solves", work.unfinished_solves},
                         {"findings", nlohmann::json::array()}};
  for (const Record& record : run.findings)
    json["findings"].push_back({{"name", record.name}, {"outcome", record.outcome}});
  return json;
}

int simulate_case(const Options& options) {
  make_folder(options.out);
  const Case shown = case_of_file(options.file, options.overrides);
  const Scene& scene = shown.scene;
  say(fmt::format("{}: {}", scene.name, fmt::join(built_parts(scene, build_system(scene)), "; ")));
  const CaseRun run = run_case(shown, options.out, provenance(options.command));
  const Work& work = run.outcome.work;
  RunRecord expected;
  expected.records = run.findings;
  if (options.json)
    fmt::print("{}\n", told(run, options).dump(1));
  else
    fmt::print("{}{}/{}: t = {:.6g} s in {} steps, {:.2f} CG iterations a solve, {:.1f} s\n",
               listing(expected), options.out, run.record.file, run.outcome.last.time, run.outcome.steps,
               double(work.cg_iterations) / double(std::max(1L, work.solves)), run.record.seconds);
  if (work.unfinished_solves > 0)
    say(fmt::format("warning: {} of {} solves hit the cap on iterations", work.unfinished_solves,
                    work.solves));
  if (!run.record.stopped.empty()) say("stopped: " + run.record.stopped);
  return run.record.stopped.empty() ? exit_code(expected) : 1;
}

/// Names the faults, writes the files that were asked for, prints, and gives the exit code.
int conclude(RunRecord& run, const Options& options, const std::string& file) {
  run.faults = read_faults(faults_path());
  name_faults(run.faults, run.records);
  if (!file.empty()) {
    make_folder(options.out);
    write_run(options.out + "/" + file, run);
    write_verdicts(options.out, run);
  }
  if (options.json)
    fmt::print("{}", verdicts_json(run));
  else
    fmt::print("{}{}\n", listing(run), summary(run));
  return exit_code(run);
}

int run_named(const Options& options, const std::string& kind) {
  RunRecord run = new_run(options);
  run_selection(select({options.names, {kind}}), reference_subject(), tier_of(options), run);
  return conclude(run, options, options.out.empty() ? "" : "run.h5");
}

int make_report(const std::string& folder) {
  const std::string script = project_folder() + "/reports/make_report.py";
  const pid_t child = fork();
  if (child == 0) {
    execl("/usr/bin/python3", "python3", script.c_str(), folder.c_str(), static_cast<char*>(nullptr));
    _exit(127);
  }
  int status = 0;
  if (child < 0 || waitpid(child, &status, 0) < 0 || !WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    say("the report could not be made: " + script);
    return bad_input;
  }
  return all_hold;
}

int run_bench(const Options& options) {
  RunRecord run = bench(options.quick ? 110'000 : 1'100'000);
  const std::string command = run.tier;
  run.provenance = provenance(options.command);
  if (!options.out.empty()) {
    make_folder(options.out);
    write_run(options.out + "/bench.h5", run);
  }
  if (options.json)
    fmt::print("{}", verdicts_json(run));
  else
    fmt::print("{}", listing(run));
  return all_hold;
}

int verify(Options options) {
  make_folder(options.out);
  RunRecord run = new_run(options);
  const auto start = std::chrono::steady_clock::now();
  run_selection(select({{}, {"check", "study"}}), reference_subject(), tier_of(options), run);
  for (const std::string& name : hard_cases())
    for (Record& record : judge_case(built_in_case(name))) run.records.push_back(std::move(record));
  for (const std::string& name : shown_cases()) {
    CaseRun done = run_case(built_in_case(name), options.out, run.provenance);
    run.cases.push_back(done.record);
    for (Record& record : done.findings) run.records.push_back(std::move(record));
  }
  run.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  run.faults = read_faults(faults_path());
  name_faults(run.faults, run.records);
  write_run(options.out + "/run.h5", run);
  write_verdicts(options.out, run);

  RunRecord speeds = bench(tier_of(options) == Tier::full ? 1'100'000 : 110'000);
  speeds.provenance = run.provenance;
  write_run(options.out + "/bench.h5", speeds);
  const int reported = options.no_report ? all_hold : make_report(options.out);
  if (options.json)
    fmt::print("{}", verdicts_json(run));
  else
    fmt::print("{} ({:.0f} s)\n", summary(run), run.seconds);
  return reported != all_hold ? reported : exit_code(run);
}

// ---- the command line

constexpr const char* examples = R"(Examples:
  foldproof verify                                    everything of the quick tier, and the report results/report.html
  foldproof simulate cases/hanging_sheet.toml --set bending.stiffness=1e-3 --out results
  foldproof simulate cases/any_mesh.toml --set cloth.mesh=body.obj
  foldproof check bending                             all checks of bending
  foldproof check bending.forces-sum-to-zero --json   one of them, for another program
  foldproof study time-order.hinge                    one study
  foldproof evaluate bending hinges.csv               forces of your hinges, in 17 digits
Exit code: 0 all hold, 1 something fails, 2 bad input.)";

constexpr const char* evaluate_help =
    R"(Prints the bending forces of single hinges, to compare another code with. Each row of FILE has 27 comma-separated numbers:
  x1 x2 x3 x4 (12 position components [m]), v1 v2 v3 v4 (12 velocity components [m/s]), ke [J], kd [N s], theta0 [rad].
Output: 12 elastic and 12 damping force components [N] in 17 digits. The weight |E|^2/(|N1|+|N2|) is taken at the current positions, or, with --rest, at
the rest positions: rows of 12 numbers.)";

std::string typed(int argc, char** argv) {
  std::string command = "build/foldproof";
  for (int k = 1; k < argc; ++k) command += std::string(" ") + argv[k];
  return command;
}

CLI::Option* add_out(CLI::App* command, Options& options, const std::string& what) {
  return command->add_option("--out", options.out, what);
}

int run(int argc, char** argv) {
  Options options;
  options.command = typed(argc, argv);
  CLI::App app(
      "Verification suite and reference implementation for cloth simulation, after Bridson, Marino, Fedkiw "
      "(2003).");
  app.footer(examples);
  app.require_subcommand(1);
  app.set_version_flag("--version", [] {
    const Provenance p = provenance("");
    return fmt::format("foldproof {} ({}, {})", p.version, p.commit, p.tree);
  });

  auto* list_command = app.add_subcommand("list", "What there is: checks, studies, cases, integrators");
  auto* simulate_command = app.add_subcommand("simulate", "Simulate a case; writes NAME.h5 and NAME.xdmf");
  simulate_command->add_option("CASE", options.file, "Case file, see cases/README.md")->required();
  simulate_command->add_option("--set", options.overrides, "Override a key: table.key=value")
      ->allow_extra_args(false);
  auto* check_command = app.add_subcommand("check", "Run checks (all, or those named)");
  auto* study_command = app.add_subcommand("study", "Run studies (all, or those named)");
  auto* verify_command = app.add_subcommand("verify", "All checks, studies and cases, and the report");
  verify_command->add_flag("--no-report", options.no_report, "Write the results only");
  auto* report_command = app.add_subcommand("report", "Make DIR/report.html from stored results");
  report_command->add_option("DIR", options.file, "Folder with run.h5 or case files")->required();
  auto* evaluate_command = app.add_subcommand("evaluate", "Evaluate a formula on your numbers");
  evaluate_command->require_subcommand(1);
  auto* bending_command =
      evaluate_command->add_subcommand("bending", "Forces of single hinges from a CSV file");
  bending_command->footer(evaluate_help);
  bending_command->add_option("FILE", options.file, "CSV, 27 columns")->required();
  bending_command->add_option("--rest", options.rest_file,
                              "CSV, 12 columns: rest positions, for rest weighting");
  auto* bench_command = app.add_subcommand("bench", "Measure speed and memory; writes bench.h5");
  bench_command->add_flag("--quick", options.quick, "Up to 100k particles instead of a million");

  for (auto* command : {check_command, study_command}) {
    command->add_option("NAME", options.names, "Names or groups, as `foldproof list` shows them");
    add_out(command, options, "Also write run.h5, verdicts.json and junit.xml into this folder");
  }
  for (auto* command : {simulate_command, verify_command, bench_command})
    add_out(command, options, "Folder for results")->capture_default_str();
  for (auto* command : {check_command, study_command, verify_command})
    command->add_option("--tier", options.tier, "quick or full")
        ->check(CLI::IsMember({"quick", "full"}))
        ->capture_default_str();
  for (auto* command :
       {list_command, simulate_command, check_command, study_command, verify_command, bench_command})
    command->add_flag("--json", options.json, "Print JSON on standard output");

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? all_hold : bad_input;
  }
  if (check_command->parsed() && check_command->count("--out") == 0) options.out = "";
  if (study_command->parsed() && study_command->count("--out") == 0) options.out = "";
  if (list_command->parsed()) return list(options);
  if (simulate_command->parsed()) return simulate_case(options);
  if (check_command->parsed()) return run_named(options, "check");
  if (study_command->parsed()) return run_named(options, "study");
  if (verify_command->parsed()) return verify(options);
  if (report_command->parsed()) return make_report(options.file);
  if (bench_command->parsed()) return run_bench(options);
  evaluate_bending(options.file, options.rest_file);
  return all_hold;
}

}  // namespace
}  // namespace foldproof

int main(int argc, char** argv) {
  try {
    return foldproof::run(argc, argv);
  } catch (const std::exception& error) {
    foldproof::say(std::string("foldproof: ") + error.what());
    return foldproof::bad_input;
  }
}
