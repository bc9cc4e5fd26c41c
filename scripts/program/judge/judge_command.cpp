// foldproof judge: another solver on trial.

#include <chrono>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <utility>

#include "scripts/program/command_line/options_of_commands.h"
#include "scripts/program/command_line/out_folder.h"
#include "scripts/program/data_folder.h"
#include "scripts/program/judge/judge_frames.h"
#include "scripts/program/judge/law_sets.h"
#include "scripts/program/judge/look_first.h"
#include "scripts/program/pages/report_script.h"
#include "scripts/program/provenance.h"
#include "scripts/program/run_all.h"
#include "scripts/program/typed_solver.h"
#include "scripts/program/judge/trial_output.h"
#include "scripts/program/judge/trial_progress.h"
#include "verification/files/baseline_file.h"
#include "verification/seeds.h"
#include "verification/subjects/suite/laws.h"
#include "verification/subjects/suite/portrait.h"

namespace foldproof {

namespace {

struct JudgeOptions : Options {
  std::string law_set;  // none if empty
  std::string bundle;   // file; none if empty
};

constexpr std::string_view law_of_cost = "order.halved-steps-approach-a-limit";

/// The kept verdicts of these laws alone, so that those that are not asked are not missed. Throws
/// InputError if the baseline has none for a name that was typed: that could only pass.
std::optional<Baseline> baseline_of(const Options& options, const std::vector<Law>& laws) {
  auto baseline = baseline_of(options);
  if (!baseline) return {};
  for (const std::string& name : options.names)
    if (std::ranges::none_of(baseline->verdicts,
                             [&](const KeptVerdict& kept) { return chooses_law(name, kept.name); }))
      throw InputError(fmt::format("{}: has no verdict on '{}'", options.baseline, name));
  if (!options.names.empty())
    std::erase_if(baseline->verdicts, [&](const KeptVerdict& kept) {
      return std::ranges::find(laws, kept.name, &Law::name) == laws.end();
    });
  return baseline;
}

/// The heading of the table: the solver's own words, the settings, and the mapping.
std::string heading(const Judgement& judgement, const SolverCommand& command) {
  const Declaration& d = judgement.declaration;
  if (d.name.empty()) return fmt::format("{}: did not start\n", command.command);
  std::string text = fmt::format("{} {} (L{}, {}, {} of order {})\n", d.name, d.version, d.level,
                                 d.is_single ? "f4" : "f8", d.scheme, d.order);
  for (const auto& [key, value] : command.settings)
    text += fmt::format("  setting {} = {}\n", key, value);
  std::map<std::string, long> said;
  for (const auto& [key, value] : judgement.mapping) ++said[key];
  for (const auto& [key, value] : judgement.mapping) {
    const long others = std::exchange(said[key], 0) - 1;
    if (others < 0) continue;  // said of another scene
    text += fmt::format("  mapping of {}: {}{}\n", key, value,
                        others > 0 ? fmt::format(" ({} more in solver.json)", others) : "");
  }
  return text;
}

/// The evidence of the laws whose names begin so, for the page of several solvers.
nlohmann::json evidence_json(const std::vector<Record>& records, std::string_view beginning) {
  using nlohmann::json;
  json tables = json::array();
  for (const Record& record : records) {
    if (!record.name.starts_with(beginning) || record.finding.evidence.rows() == 0) continue;
    json columns = json::array();
    for (const Column& column : record.finding.evidence.columns()) {
      json values;
      std::visit([&](const auto& all) { values = all; }, column.values);
      columns.push_back({{"name", column.name}, {"unit", column.unit}, {"values", values}});
    }
    tables.push_back({{"law", record.name}, {"columns", columns}});
  }
  return tables;
}

/// The typed options that may change an outcome, besides --settings.
std::vector<std::string> options_that_matter(const Options& options) {
  std::vector<std::string> words;
  if (options.patience != Options().patience)
    words.insert(words.end(), {"--seconds", fmt::format("{}", options.patience)});
  if (options.total_seconds > 0)
    words.insert(words.end(), {"--total-seconds", fmt::format("{}", options.total_seconds)});
  if (options.law_seconds > 0)
    words.insert(words.end(), {"--law-seconds", fmt::format("{}", options.law_seconds)});
  if (options.seed_shift > 0)
    words.insert(words.end(), {"--seed", fmt::format("{}", options.seed_shift)});
  for (const std::string& name : options.skipped) words.insert(words.end(), {"--skip", name});
  return words;
}

/// Null where it is not asked for: with some laws alone, or without a folder.
nlohmann::json portrait_json(const SolverCommand& command, const Options& options,
                             bool smoke_holds) {
  if (!options.names.empty() || options.out.empty()) return nullptr;
  if (!smoke_holds) return {{"why_none", "not asked: a smoke law fails"}};
  const suite::Portrait portrait = suite::portrait_of(command);
  if (!portrait.why_none.empty()) return {{"why_none", portrait.why_none}};
  const PortableSphere& ball = portrait.scene.spheres.front();
  nlohmann::json x = nlohmann::json::array();
  for (Eigen::Index i = 0; i < portrait.x.cols(); ++i)
    x.push_back({portrait.x(0, i), portrait.x(1, i), portrait.x(2, i)});
  return {{"about", portrait.about},
          {"x", x},
          {"triangles", portrait.scene.mesh.triangles},
          {"centre", {ball.centre.x(), ball.centre.y(), ball.centre.z()}},
          {"radius", ball.radius}};
}

/// For each law: its scenes, steps and particles.
nlohmann::json asked_json(const Judgement& judgement) {
  nlohmann::json all = nlohmann::json::object();
  for (size_t k = 0; k < judgement.asked.size(); ++k) {
    const Observed& asked = judgement.asked[k];
    if (asked.scenes > 0)
      all[judgement.records[k].name] = {{"scenes", asked.scenes},
                                        {"advances", asked.advances},
                                        {"steps", asked.steps},
                                        {"particle_steps", asked.particle_steps},
                                        {"particles", asked.most_particles}};
  }
  return all;
}

/// What the solver says of itself, and how it was asked; empty texts if it did not start.
std::string solver_json(const Judgement& judgement, const SolverCommand& command,
                        const Options& options, const std::optional<LawSetUse>& set) {
  using nlohmann::json;
  const Declaration& d = judgement.declaration;
  const bool started = !d.name.empty();
  json said = {{"schema", 1},
               {"name", d.name},
               {"version", d.version},
               {"level", started ? fmt::format("L{}", d.level) : ""},
               {"precision", !started      ? ""
                             : d.is_single ? "f4"
                                           : "f8"},
               {"scheme", d.scheme},
               {"order", d.order},
               {"capabilities", d.capabilities},
               {"solve_tolerance", d.solve_tolerance},
               {"mass_matrix", d.has_consistent_mass ? "consistent" : "lumped"},
               {"substep", d.substep},
               {"deterministic", d.is_deterministic},
               {"contact_offset", d.contact_offset},
               {"asked", asked_json(judgement)},
               {"command", command.command},
               {"options", options_that_matter(options)},
               {"settings", json::object()},
               {"mapping", json::object()},
               {"calibration", evidence_json(judgement.records, "calibration.")},
               {"cost", evidence_json(judgement.records, law_of_cost)},
               {"portrait", portrait_json(command, options, judgement.smoke_holds)}};
  if (set) said["laws"] = {{"set", set->name}, {"changed", set->changed}, {"gone", set->gone}};
  for (const auto& [key, value] : command.settings) said["settings"][key] = value;
  for (const auto& [key, value] : judgement.mapping) {
    json& words = said["mapping"][key];  // scenes may be mapped otherwise
    words = words.is_null() ? value : words.get<std::string>() + "; " + value;
  }
  return said.dump(1, ' ', false, json::error_handler_t::replace) + "\n";
}

/// The evidence of that law as a curve; none where it does not hold: without a limit, no error.
std::optional<StudyRecord> error_against_cost(const Judgement& judgement, const std::string& name) {
  const auto record = std::ranges::find(judgement.records, law_of_cost, &Record::name);
  if (record == judgement.records.end() || record->outcome != Outcome::holds) return {};
  const Table& rows = record->finding.evidence;
  const Curve curve = curve_of(name, rows, "seconds by the clock", "error");
  StudyRecord study;
  study.name = "solver.error-against-cost";
  study.claim = "What error does a second of the solver buy?";
  study.source = "the law " + record->name;
  study.about =
      "The error of the time step, not of the model: its limit is the solver's own. Seconds are "
      "the clock of one machine, through the pipe: the least of up to five readings.";
  study.figures.push_back(
      {"error_against_cost",
       "Error against cost",
       {"seconds of 0.04 s of motion, by the clock", "s", Scale::log},
       {"error of the step, over the motion", "1", Scale::log},
       nan,
       "One mark for each step size; the error is that of the end, against the extrapolated one.",
       {curve}});
  study.tables.emplace_back("steps", "Each step", rows);
  return study;
}

RunRecord run_of(const Judgement& judgement, double seconds, const Options& options) {
  RunRecord run;
  run.provenance = provenance(options.command);
  run.seconds = seconds;
  run.tier = options.tier;
  run.seed = options.seed_shift;
  run.subject = options.name.empty() ? judgement.declaration.name : options.name;
  if (run.subject.empty()) run.subject = options.solver;
  run.subject_version = judgement.declaration.version;
  run.records = judgement.records;
  if (const Declaration& d = judgement.declaration; !d.name.empty())
    run.declared = {d.level, d.is_single ? "f4" : "f8", d.order, d.solve_tolerance, d.capabilities};
  if (const auto study = error_against_cost(judgement, run.subject)) run.studies.push_back(*study);
  return run;
}

constexpr const char* smoke_failed =
    "A smoke law fails: suspect the adapter before the engine. Try `foldproof subject --check`.\n";

/// Those that are asked, and how the chosen set differs from them.
std::vector<Law> asked_laws(const JudgeOptions& options, std::optional<LawSetUse>& set) {
  std::vector<Law> laws = chosen_laws(options.names, options.skipped);
  if (!options.law_set.empty()) set = keep_laws_of_set(options.law_set, laws);
  if (laws.empty()) throw InputError("no law is both named and in law set " + options.law_set);
  return laws;
}

int judge_another_solver(const JudgeOptions& options) {
  if (!options.frames.empty()) return judge_frames_of_a_case(options);
  if (options.solver.empty())
    throw InputError("judge needs --solver CMD, or --frames DIR with --case CASE");
  if (options.out.empty() && (options.resumes || options.restarts))
    throw InputError("--resume and --restart need --out, the folder of the interrupted trial");
  std::optional<LawSetUse> set;
  const std::vector<Law> laws = asked_laws(options, set);
  seed_shift = options.seed_shift;
  const auto baseline = baseline_of(options, laws);
  const auto bugs = read_planted_bugs(data_folder() + "/verification/subjects/planted_bugs.jsonl");
  const OutFolder folder(options.out);
  SolverCommand command = solver_command(options);
  const auto start = std::chrono::steady_clock::now();
  if (options.total_seconds > 0)
    command.limits.end = start + std::chrono::duration_cast<std::chrono::steady_clock::duration>(
                                     std::chrono::duration<double>(options.total_seconds));
  TrialProgress progress(options, laws);
  const Judgement judgement = judge_solver(command, laws, progress.watch());
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const std::string below = (judgement.smoke_holds ? "" : smoke_failed) +
                            look_first_text(likely_causes(bugs, judgement.records)) +
                            progress.asked_text();
  const int code = finish_trial(
      {run_of(judgement, seconds, options), solver_json(judgement, command, options, set),
       heading(judgement, command) + (set ? text_of(*set, laws.size()) : ""), below},
      baseline, options);
  if (std::ranges::none_of(judgement.records, did_not_run)) drop_kept_results(options.out);
  if (options.bundle.empty()) return code;
  const int bundled = run_report_script("bundle", "make_results.py",
                                        {"bundle", options.out, options.bundle, program_file()});
  return bundled == all_hold ? code : bundled;
}

/// Frames instead of a solver.
void add_judged_frames(CLI::App* judge, CLI::Option* solver, Options& options) {
  CLI::Option* frames = judge->add_option(
      "--frames", options.frames,
      "Instead of a solver: folder of its OBJ or PLY files, one a frame, or a cache "
      "of all frames (.pc2, .npz, .usda)");
  frames->type_name("FRAMES")->check(some_text("a folder or a cache"))->excludes(solver);
  CLI::Option* of = judge->add_option("--case", options.file,
                                      std::string("The case of the frames. ") + case_words);
  of->type_name("CASE")->check(some_text("a case"))->needs(frames);
  for (CLI::Option* time : add_frame_times(judge, options)) time->needs(frames);
  add_overrides(judge, options);
  add_cache(judge, options);
  for (const char* of_a_case : {"--set", "--cache"}) judge->get_option(of_a_case)->needs(frames);
}

constexpr const char* below_judge =
    R"(Without an adapter: --frames judges files that any program wrote, as a motion of the case's cloth:
crossings, depth in objects, strain, folds, energy, and what the case expects.

CMD starts an adapter that speaks the protocol of verification/subjects/PROTOCOL.md, in a process of
its own. Simple laws (smoke) come first: if one fails, suspect the adapter. If the solver crashes,
hangs or answers nonsense, the current law fails and shows its last output; the next law then runs.
If it cannot be started, hangs a third time, or --total-seconds are over, the laws that are left do
not run. Name laws or groups to judge only those, such as: contact symmetry.mirror

Examples:
  foldproof judge --frames my_frames --case drape_sphere --rate 60 --out mine
  foldproof judge --solver ./adapter --name mine --settings iterations=20 --out mine

Exit codes:
  0    every law holds, or does not apply; with --baseline: nothing got worse
  1    a law fails, is inconclusive or did not run; with --baseline: something got worse
  2    bad input)";

void add_trial_options(CLI::App* judge, CLI::Option* solver, JudgeOptions& options) {
  add_value(judge, "--laws SET", options.law_set,
            "Ask the laws of a frozen set alone, such as 2026.1; says which of them changed since",
            some_text("a law set"))
      ->needs(solver);
  add_value(judge, "--bundle FILE", options.bundle,
            "With --out and --laws: also write all that the result rests on into one file, with a "
            "run of the reference, for `foldproof results add`",
            some_text("a file"))
      ->needs("--laws");
  add_value(judge, "--law-seconds S", options.law_seconds,
            "Longest time of a law [s], looked at between calls (default: no limit); it then did "
            "not run, and the next one goes on",
            positive_number())
      ->needs(solver);
  add_value(judge, "--skip LAW", options.skipped, "Leave these laws out; may be given again",
            some_text("a law"))
      ->needs(solver)
      ->allow_extra_args(false);
  add_value(judge, "--dump DIR", options.dump,
            "Write each scene with the last answer, as DIR/LAW/NUMBER.json", some_text("a folder"))
      ->needs(solver);
  add_value(judge, "--seed N", options.seed_shift,
            "Draw other numbers of scenes, 0 to 1000000000; official results use 0",
            whole_number(0, 1'000'000'000))
      ->needs(solver);
  add_resuming(judge, options);
}

}  // namespace

void add_judge_command(CLI::App& app, Program& program) {
  auto [judge, options] = add_command(
      app, program, {"judge", "Test another solver against the laws of cloth", below_judge},
      judge_another_solver);
  CLI::Option* solver =
      judge->add_option("--solver", options.solver, "Command that starts the solver's adapter");
  solver->type_name("CMD")->check(some_text("a command"));
  judge
      ->add_option("LAW", options.names,
                   "Laws to judge, by name, group or how the name begins, as `foldproof list laws` "
                   "shows them")
      ->needs(solver);
  add_judged_frames(judge, solver, options);
  add_value(judge, "--name NAME", options.name, "Name in the report (default: the solver's own)",
            some_text("a name"));
  add_value(judge, "--baseline FILE", options.baseline,
            "A kept verdicts.json of `judge`: fail only where the solver got worse since",
            some_text("a file"));
  add_solver_options(judge, options);
  judge->get_option("--settings")->needs("--solver");
  add_value(judge, "--total-seconds S", options.total_seconds,
            "Longest time of all laws together [s] (default: no limit); laws that it does "
            "not reach did not run",
            positive_number())
      ->needs(solver);
  add_trial_options(judge, solver, options);
  add_out_if_typed(judge, options,
                   "Also write run.h5, verdicts.json, junit.xml and solver.json into this folder");
  judge->get_option("--bundle")->needs("--out");
  add_json(judge, options);
}

}  // namespace foldproof
