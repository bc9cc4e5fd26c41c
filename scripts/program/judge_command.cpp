// foldproof judge, subject, serve: another solver on trial, its adapter, and the reference as one.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "scripts/program/command_line/out_folder.h"
#include "scripts/program/command_line/suggestions.h"
#include "scripts/program/commands.h"
#include "scripts/program/progress.h"
#include "scripts/program/provenance.h"
#include "scripts/program/run_all.h"
#include "scripts/program/solver_command.h"
#include "scripts/program/trial_output.h"
#include "verification/files/baseline_file.h"
#include "verification/subjects/served/reference_server.h"
#include "verification/subjects/suite/conformance.h"
#include "verification/subjects/suite/laws.h"
#include "verification/subjects/suite/portrait.h"

namespace foldproof {

namespace {

constexpr std::string_view law_of_cost = "order.halved-steps-approach-a-limit";

/// The laws of these names or groups, all if there is none. Throws InputError for a name that
/// chooses nothing, with the nearest known ones.
std::vector<Law> chosen_laws(const std::vector<std::string>& names) {
  std::vector<Law> laws = portable_laws();
  for (const std::string& name : names) {
    std::vector<std::string> known;
    for (const Law& law : laws)
      known.insert(known.end(), {law.name, law.name.substr(0, law.name.find('.'))});
    const auto is_chosen = [&](const Law& law) { return chooses(name, law.name); };
    if (std::ranges::any_of(laws, is_chosen)) continue;
    const std::string meant = did_you_mean(nearest_names(name, known));
    throw InputError(fmt::format("there is no law '{}' (`foldproof list laws` shows all){}", name,
                                 meant.empty() ? "; is CMD in quotes?" : meant));
  }
  std::erase_if(laws, [&](const Law& law) {
    return !names.empty() && std::ranges::none_of(names, [&](const std::string& name) {
      return chooses(name, law.name);
    });
  });
  return laws;
}

/// The kept verdicts of these laws alone, so that those that are not asked are not missed. Throws
/// InputError if the baseline has none for a name that was typed: that could only pass.
std::optional<Baseline> baseline_of(const Options& options, const std::vector<Law>& laws) {
  auto baseline = baseline_of(options);
  if (!baseline) return {};
  for (const std::string& name : options.names)
    if (std::ranges::none_of(baseline->verdicts,
                             [&](const KeptVerdict& kept) { return chooses(name, kept.name); }))
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
  for (const auto& [key, value] : judgement.mapping)
    text += fmt::format("  mapping of {}: {}\n", key, value);
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

/// What the solver says of itself, and how it was asked; empty texts if it did not start.
std::string solver_json(const Judgement& judgement, const SolverCommand& command,
                        const Options& options) {
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
               {"command", command.command},
               {"options", options_that_matter(options)},
               {"settings", json::object()},
               {"mapping", json::object()},
               {"calibration", evidence_json(judgement.records, "calibration.")},
               {"cost", evidence_json(judgement.records, law_of_cost)},
               {"portrait", portrait_json(command, options, judgement.smoke_holds)}};
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

}  // namespace

int judge_another_solver(const Options& options) {
  if (!options.frames.empty()) return judge_frames_of_a_case(options);
  if (options.solver.empty())
    throw InputError("judge needs --solver CMD, or --frames DIR with --case CASE");
  const std::vector<Law> laws = chosen_laws(options.names);
  const auto baseline = baseline_of(options, laws);
  const OutFolder folder(options.out);
  SolverCommand command = solver_command(options);
  const auto start = std::chrono::steady_clock::now();
  if (options.total_seconds > 0)
    command.limits.end = start + std::chrono::duration_cast<std::chrono::steady_clock::duration>(
                                     std::chrono::duration<double>(options.total_seconds));
  const Judgement judgement = judge_solver(command, laws, [](const Record& record) {
    if (record.outcome == Outcome::fails || record.outcome == Outcome::inconclusive)
      log_line(fmt::format("{} {}", outcome_text(record), record.name));
  });
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const std::string below = judgement.smoke_holds ? "" : smoke_failed;
  return finish_trial(
      {run_of(judgement, seconds, options), solver_json(judgement, command, options),
       heading(judgement, command), below},
      baseline, options);
}

int check_subject(const Options& options) {
  const char* const words[] = {"kept", "declined", "BROKEN"};
  bool is_broken = false;
  for (const ConformanceRow& row : check_conformance(solver_command(options))) {
    fmt::print("{:<9} {:<44} {}\n", words[int(row.conformity)], row.demand, row.note);
    is_broken |= row.conformity == Conformity::broken;
  }
  fmt::print("{}\n", is_broken ? "the adapter does not keep to the protocol"
                               : "the adapter keeps to the protocol");
  return is_broken ? some_fail : all_hold;
}

int serve(const Options& options) {
  return serve_reference({options.integrator, options.precision == "f4"});
}

}  // namespace foldproof
