// The program: what can be typed, and nothing else. See `foldproof --help`.
#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <csignal>
#include <cstdio>
#include <memory>
#include <new>

#include "scripts/program/command_line/command_line.h"
#include "scripts/program/campaign/campaign_commands.h"
#include "scripts/program/commands.h"
#include "scripts/program/data_folder.h"
#include "scripts/program/command_line/help_texts.h"
#include "scripts/program/progress.h"
#include "scripts/program/provenance.h"
#include "verification/oracles/golden.h"

namespace foldproof {
namespace {

std::string command_line(int argc, char** argv) {
  std::string command = program_command();
  for (int k = 1; k < argc; ++k) command += std::string(" ") + argv[k];
  return command;
}

constexpr const char* case_words =
    "Case file, NAME.toml (cases/KEYS.md), or a shipped case, as `foldproof list` names them";

/// A command as its help shows it: `what` it does in a line, and what stands below its options.
struct CommandText {
  const char* name;
  const char* what;
  const char* below;
};

/// A command that runs `run` when it was typed.
CLI::App* add_command(CLI::App& app, Options& options, const CommandText& text,
                      int (*run)(const Options&)) {
  CLI::App* command = app.add_subcommand(text.name, text.what);
  command->footer(text.below);
  command->group("Commands");
  command->callback([&options, run] { options.run = run; });
  return command;
}

void add_json(CLI::App* command, Options& options) {
  command->add_flag("--json", options.json, "Print JSON on standard output")
      ->disable_flag_override();
}

CLI::Option* add_switch(CLI::App* command, const std::string& name, bool& value,
                        const std::string& what) {
  return command->add_flag(name, value, what)->disable_flag_override();
}

/// Input files that a command needs.
template <class Files>
CLI::Option* add_input(CLI::App* command, const std::string& name, Files& files,
                       const std::string& what) {
  return command->add_option(name, files, what)->check(some_text("a file or folder"))->required();
}

CLI::Option* add_folder(CLI::App* command, Options& options, const std::string& what) {
  return command->add_option("--out", options.out, what)
      ->type_name("DIR")
      ->check(some_text("a folder"));
}

void add_tier(CLI::App* command, Options& options) {
  command->add_option("--tier", options.tier, "quick (minutes) or full (hours)")
      ->type_name("TIER")
      ->check(one_of({"quick", "full"}))
      ->capture_default_str();
}

void add_overrides(CLI::App* command, Options& options) {
  command
      ->add_option("--set", options.overrides,
                   "Override a key of the case file, such as time.end=2; may be given again")
      ->type_name("TABLE.KEY=VALUE")
      ->check(some_text("table.key=value"))
      ->allow_extra_args(false);
}

/// Level sets are kept only where a folder is named: a run leaves nothing behind that it
/// was not asked for.
void add_cache(CLI::App* command, Options& options) {
  command
      ->add_option("--cache", options.cache,
                   "Keep the level sets of meshes in this folder for later runs; the results are "
                   "the same to the bit")
      ->type_name("DIR")
      ->check(some_text("a folder"));
}

void add_threads(CLI::App* command, Options& options) {
  command->add_option("--threads", options.running.threads, "Jobs at a time (default: one a core)")
      ->type_name("N")
      ->check(whole_number(1, 1024));
}

/// How checks, studies and cases are run, and on which samples.
void add_running(CLI::App* command, Options& options) {
  command
      ->add_option("--seed", options.seed_shift,
                   "Shift the seeds of all random samples, 0 to 1000000000; official results use 0")
      ->type_name("N")
      ->check(whole_number(0, 1'000'000'000))
      ->capture_default_str();
  add_threads(command, options);
  command
      ->add_option("--order", options.running.order,
                   "Shuffle the jobs, with N as the seed (default: the longest first)")
      ->type_name("N")
      ->check(whole_number(0, 1'000'000'000));
}

/// --out that has no value where it was not typed.
void add_out_if_typed(CLI::App* command, Options& options, const std::string& what) {
  add_folder(command, options, what);
  command->parse_complete_callback([&options, command] {
    if (command->count("--out") == 0) options.out = "";
  });
}

/// check and study: they write files only if a folder is named.
void add_selections(CLI::App& app, Options& options) {
  for (CLI::App* command :
       {add_command(app, options, {"check", "Run checks (all, or those named)", help::check},
                    run_checks),
        add_command(app, options, {"study", "Run studies (all, or those named)", help::study},
                    run_studies)}) {
    command->add_option("NAME", options.names, "Names or groups, as `foldproof list` shows them");
    add_out_if_typed(command, options,
                     "Also write run.h5, verdicts.json and junit.xml into this folder");
    add_running(command, options);
    add_tier(command, options);
    add_json(command, options);
  }
}

void add_simulate(CLI::App& app, Options& options) {
  CLI::App* simulate = add_command(
      app, options, {"simulate", "Simulate a case; writes NAME.h5 and NAME.xdmf", help::simulate},
      simulate_case);
  add_input(simulate, "CASE", options.file, case_words);
  add_overrides(simulate, options);
  CLI::Option* resume = add_switch(
      simulate, "--resume", options.resumes,
      "Resume from the last checkpoint of an interrupted run; the results are the same to the bit");
  add_switch(simulate, "--restart", options.restarts,
             "Start over; deletes checkpoints of an interrupted run")
      ->excludes(resume);
  add_cache(simulate, options);
  add_folder(simulate, options, "Folder for results")->capture_default_str();
  add_json(simulate, options);
}

void add_runs(CLI::App& app, Options& options) {
  add_simulate(app, options);
  CLI::App* everything = add_command(
      app, options,
      {"verify", "Run all checks, studies and cases; give rulings on claims, write the report",
       help::verify},
      verify);
  add_switch(everything, "--no-report", options.no_report, "Write the results only");
  add_switch(everything, "--no-bench", options.no_bench, "Do not measure speed");
  add_running(everything, options);
  add_tier(everything, options);
  CLI::App* speed = add_command(
      app, options, {"bench", "Measure speed and memory; writes bench.h5", help::bench}, run_bench);
  add_switch(speed, "--quick", options.quick, "Up to 100k particles instead of a million");
  add_cache(everything, options);
  for (CLI::App* command : {everything, speed}) {
    add_folder(command, options, "Folder for results")->capture_default_str();
    add_json(command, options);
  }
}

void add_ablate(CLI::App& app, Options& options) {
  CLI::App* ablate = add_command(
      app, options,
      {"ablate",
       "Which of its parts does a case need, and which does it lack? Adds to ablation.json",
       help::ablate},
      ::foldproof::ablate);
  ablate
      ->add_option("CASE", options.names,
                   "Case files, or names of shipped cases (default: all of the tier)")
      ->check(some_text("a case file"));
  add_tier(ablate, options);
  add_overrides(ablate, options);
  add_threads(ablate, options);
  add_cache(ablate, options);
  add_folder(ablate, options, "Folder for ablation.json")->capture_default_str();
  add_json(ablate, options);
}

/// The integrators to run; `usual` are those of a command without the option.
void add_method(CLI::App* command, Options& options, const std::string& usual) {
  command
      ->add_option("--method", options.methods,
                   "Integrators: a list such as A,C,RK4, or all (default: " + usual + ")")
      ->type_name("METHODS")
      ->check(some_text("integrators, or all"))
      ->delimiter(',')
      ->allow_extra_args(false);
}

/// Options of the ladder: its direction, levels, methods and limits.
void add_ladder(CLI::App* converge, Options& options) {
  converge
      ->add_option("--in", options.in,
                   "Refine time (the steps), space (the mesh), or both, one after the other")
      ->type_name("WHAT")
      ->check(one_of({"time", "space", "both"}))
      ->capture_default_str();
  converge
      ->add_option("--levels", options.levels,
                   "Runs, 3 to 12, each with half the steps, or edges half as long")
      ->type_name("N")
      ->check(whole_number(3, 12))
      ->capture_default_str();
  add_method(converge, options, "case's own");
  converge->add_flag("--refine-objects", options.refines_objects,
                     "In space: also refine the level sets of objects, by the same factor");
  converge
      ->add_option("--until", options.until,
                   "Use only the beginning of the run, up to this time [s]")
      ->type_name("TIME")
      ->check(positive_number());
  converge
      ->add_option("--hours", options.hours,
                   "Refuse levels that would make the whole call take longer than this [h]")
      ->type_name("H")
      ->check(positive_number());
}

/// Options of the disturbed runs.
void add_twins(CLI::App* converge, Options& options) {
  converge
      ->add_option(
          "--fraction", options.fraction,
          "Positions count as unpredictable once disturbed runs differ by this share of the motion")
      ->type_name("SHARE")
      ->check(share())
      ->capture_default_str();
  converge
      ->add_option("--ensemble", options.ensemble,
                   "Runs with disturbed starts, whose statistics are compared once positions are "
                   "not predictable; below 2: none")
      ->type_name("N")
      ->check(whole_number(0, 1000))
      ->capture_default_str();
}

void add_errors(CLI::App* command, Options& options, const std::string& what) {
  command->add_option("--errors", options.errors, what)
      ->type_name("ERRORS")
      ->check(positive_number())
      ->delimiter(',')
      ->allow_extra_args(false);
}

void add_converge(CLI::App& app, Options& options) {
  CLI::App* converge = add_command(
      app, options,
      {"converge",
       "How large are the errors of a case's step and mesh? Orders, limits and error bars",
       help::converge},
      ::foldproof::converge);
  add_input(converge, "CASE", options.file, case_words);
  add_ladder(converge, options);
  add_twins(converge, options);
  add_errors(converge, options,
             "In both: errors to find the cheapest step and mesh for, as shares of the motion "
             "(default: 1e-2,1e-3)");
  add_overrides(converge, options);
  add_folder(converge, options,
             "Folder whose store/ keeps every run; a second call runs only missing ones")
      ->capture_default_str();
  add_cache(converge, options);
  add_threads(converge, options);
  add_json(converge, options);
}

void add_precision(CLI::App& app, Options& options) {
  CLI::App* precision =
      add_command(app, options,
                  {"precision",
                   "Which integrator is cheapest for a case at a wanted error? Writes precision.h5",
                   help::precision},
                  ::foldproof::precision);
  add_input(precision, "CASE", options.file, case_words);
  add_method(precision, options, "all");
  add_errors(precision, options, "Wanted errors, as shares of the motion (default: 1e-2,1e-3)");
  precision
      ->add_option("--until", options.until,
                   "Use only the beginning of the run, up to this time [s]")
      ->type_name("TIME")
      ->check(positive_number());
  precision
      ->add_option("--effort", options.effort,
                   "Let each run take this many times the usual work, for shorter steps")
      ->type_name("TIMES")
      ->check(positive_number())
      ->capture_default_str();
  add_overrides(precision, options);
  add_folder(precision, options,
             "Folder for precision.h5; its store/ keeps every run, and a second call makes only "
             "what is missing")
      ->capture_default_str();
  add_cache(precision, options);
  add_threads(precision, options);
  add_json(precision, options);
}

CLI::Option* add_length(CLI::App* command, const std::string& name, double& value,
                        const std::string& what) {
  return command->add_option(name, value, what)->type_name("LENGTH")->check(finite_number());
}

void add_project(CLI::App& app, Options& options) {
  CLI::App* project = add_command(
      app, options,
      {"project", "Move the cloth of a stored run out of its objects; writes NAME_projected.h5",
       help::project},
      project_run);
  add_input(project, "RUN.h5", options.file, "Run stored by `foldproof simulate`");
  project->add_option("--map", options.map, "Map of depth: plain, power or blend")
      ->type_name("MAP")
      ->check(one_of({"plain", "power", "blend"}))
      ->required();
  add_length(project, "--tau", options.reach, "Move also points outside, up to this distance [m]")
      ->required();
  add_length(project, "--eps", options.eps,
             "Final distance of the deepest points outside the object [m]")
      ->capture_default_str();
  add_length(project, "--deepest", options.deepest,
             "Depths [m] beyond this are treated alike (default: the deepest in the run)");
  project
      ->add_option("--subdivide", options.subdivisions,
                   "Levels of subdivision before the projection, 0 to 8")
      ->type_name("N")
      ->check(whole_number(0, 8))
      ->capture_default_str();
  project->add_option("--rule", options.rule, "Rule of subdivision: loop or midpoint")
      ->type_name("RULE")
      ->check(one_of({"loop", "midpoint"}))
      ->capture_default_str();
  add_cache(project, options);
  add_folder(project, options, "Folder for the projected run")->capture_default_str();
  add_json(project, options);
}

void add_film(CLI::App& app, Options& options) {
  CLI::App* film = add_command(
      app, options, {"film", "Make a film of a stored run (MP4 and GIF, by ffmpeg)", help::film},
      make_film);
  add_input(film, "RUN.h5", options.file, "Run stored by `foldproof simulate`");
  film->add_option("--field", options.field,
                   "Colour the cloth by strain [1], angle [rad], phi [m] or speed [m/s] (default: "
                   "by its sides)")
      ->type_name("FIELD")
      ->check(one_of({"strain", "angle", "phi", "speed"}));
  film->add_option("--size", options.size, "Width and height in pixels (default: 1280x720)")
      ->type_name("WxH")
      ->check(some_text("a size, such as 1280x720"));
  film->add_option("--fps", options.fps, "Pictures a second, 1 to 120 (default: 30)")
      ->type_name("N")
      ->check(whole_number(1, 120));
  add_out_if_typed(film, options, "FILE.mp4 or FILE.gif (default: both, beside RUN.h5)");
  film->get_option("--out")->type_name("FILE");
}

void add_history(CLI::App& app, Options& options) {
  CLI::App* history = add_command(
      app, options,
      {"history", "Show what changed over several runs, and in which run first", help::history},
      show_history);
  history
      ->add_option("DIR", options.names, "Folders of finished runs, or their verdicts.json files")
      ->check(some_text("a file or folder"));
  history
      ->add_option("--log", options.log,
                   "Log in JSON lines, one a run: append the given runs, then show all of them")
      ->type_name("FILE")
      ->check(some_text("a file"));
  add_out_if_typed(history, options, "Also write a page to this file");
  history->get_option("--out")->type_name("FILE");
  add_json(history, options);
}

/// Reports from stored results.
void add_pages(CLI::App& app, Options& options) {
  CLI::App* report = add_command(
      app, options,
      {"report", "Make DIR/report.html from stored results, or compare folders", help::report},
      make_report);
  add_input(
      report, "DIR", options.names,
      "Folder with run.h5 or case files; two of them, or several judged solvers, are compared")
      ->expected(1, 20);
  add_switch(report, "--summary", options.summary,
             "Write the one-page verdict instead: DIR/summary.html, .md and .pdf");
  add_switch(report, "--site", options.site,
             "Write a folder of pages instead: DIR/report/index.html");
  add_switch(report, "--pdf", options.pdf, "Also write DIR/report.pdf, printed by chromium");
  add_switch(report, "--papers", options.papers,
             "Also write figures and pictures as PDF and PNG files, in DIR/figures");
  add_history(app, options);
  add_film(app, options);
  CLI::App* files =
      add_command(app, options,
                  {"export", "Write the frames of a stored run as files for other programs",
                   help::export_frames},
                  export_frames);
  add_input(files, "RUN.h5", options.file, "Run stored by `foldproof simulate`");
  files->add_option("--format", options.kind, "obj, ply or xdmf")
      ->type_name("FORMAT")
      ->check(one_of({"obj", "ply", "xdmf"}))
      ->required();
  add_folder(files, options, "Folder for the files")->required();
}

void add_golden(CLI::App& app, Options& options) {
  CLI::App* golden = add_command(
      app, options,
      {"golden", "Print inputs and correctly rounded outputs of a formula, for your unit tests",
       help::golden},
      print_golden_values);
  golden
      ->add_option("TABLE", options.file,
                   "bending, springs, integrator, forecast, friction, projection or sticking")
      ->required()
      ->check(one_of(golden_names()));
  golden->add_option("--count", options.count, "Rows")
      ->type_name("N")
      ->check(whole_number(1, 1'000'000'000))
      ->capture_default_str();
  golden
      ->add_option("--seed", options.seed, "Seed of the inputs; the same seed gives the same rows")
      ->type_name("N")
      ->check(whole_number(0, 4'294'967'295))
      ->capture_default_str();
  add_json(golden, options);
}

void add_evaluate(CLI::App& app, Options& options) {
  CLI::App* evaluate = app.add_subcommand("evaluate", "Evaluate a formula on your numbers");
  evaluate->group("Commands");
  evaluate->require_subcommand(0, 1);
  evaluate->footer(help::evaluate);
  CLI::App* bending =
      add_command(*evaluate, options,
                  {"bending", "Forces of single hinges from a CSV file", help::evaluate_bending},
                  evaluate_hinges);
  add_input(bending, "FILE", options.file, "CSV, 27 columns");
  bending
      ->add_option("--rest", options.rest_file,
                   "CSV, 12 columns: rest positions [m], for rest weighting")
      ->type_name("FILE")
      ->check(some_text("a file"));
  CLI::App* queries =
      add_command(*evaluate, options,
                  {"crossings",
                   "Do moving features meet? Compare the reference and the exact judge with a file",
                   help::evaluate_crossings},
                  evaluate_queries);
  add_input(queries, "FILE,--ccd-data", options.file,
            "CSV file with 7 columns and 8 rows a query, or a folder of such files")
      ->type_name("FILE");
  queries
      ->add_option("--kind", options.kind, "vertex-face or edge-edge (default: as the path says)")
      ->type_name("KIND")
      ->check(one_of({"vertex-face", "edge-edge"}));
  add_length(queries, "--keep", options.keep, "Clearance that the reference should keep [m]")
      ->capture_default_str();
}

void add_compare(CLI::App& app, Options& options) {
  CLI::App* compare = add_command(
      app, options,
      {"compare", "How far are frames of another program, or a captured cloth, from a stored run?",
       help::compare},
      compare_frames);
  add_input(compare, "RUN.h5", options.file, "Run stored by `foldproof simulate`");
  add_input(compare, "FRAMES", options.frames, "Folder of OBJ or PLY files, one a frame [m]");
  CLI::Option* times = compare->add_option("--times", options.times,
                                           "Times of the frames [s], one a line (default: "
                                           "times.txt in the folder, or what PLY files say)");
  times->type_name("FILE")->check(some_text("a file of times"));
  CLI::Option* rate = compare->add_option("--rate", options.rate, "Frames a second");
  rate->type_name("FPS")->check(positive_number())->excludes(times);
  compare->add_option("--start", options.first_time, "Time of the first frame [s]")
      ->type_name("TIME")
      ->check(finite_number())
      ->needs(rate)
      ->capture_default_str();
  add_cache(compare, options);
  add_out_if_typed(compare, options, "Also write run.h5 into this folder, for `foldproof report`");
  add_json(compare, options);
}

void add_readers(CLI::App& app, Options& options) {
  add_json(
      add_command(app, options,
                  {"list", "Show what there is: checks, studies, cases, integrators", help::list},
                  list),
      options);
  CLI::App* claims = add_command(
      app, options,
      {"claims", "Show the rulings of a finished run on the papers' claims", help::claims},
      show_claims);
  claims->add_option(
      "ID", options.names,
      "One claim, such as T17: its ruling, the reason, and the findings that decide it");
  claims->add_option("--paper", options.paper, "Only the claims of one paper, such as BFA02")
      ->type_name("KEY");
  add_folder(claims, options, "Folder of the finished run")->capture_default_str();
  add_json(claims, options);
  add_pages(app, options);
  CLI::App* mesh = add_command(
      app, options,
      {"inspect", "Is a mesh valid as a body? With --cloth: how stiff is it as a cloth?",
       help::inspect},
      inspect);
  add_input(mesh, "MESH.obj", options.file, "An OBJ file");
  mesh->add_flag("--cloth", options.as_cloth,
                 "As a cloth: rigidity by direction, elastic limit, thinnest triangles");
  mesh->add_option("--cells", options.cells, "Grid cells along the longest side")
      ->type_name("N")
      ->check(whole_number(4, 1000))
      ->capture_default_str();
  add_json(mesh, options);
  CLI::App* crossings =
      add_command(app, options,
                  {"crossings", "Does a cloth pass through itself in any frame? Decided exactly",
                   help::crossings},
                  show_crossings);
  add_input(crossings, "FILE", options.names, "Stored runs (.h5), or meshes (.obj), each a frame");
  add_json(crossings, options);
  add_compare(app, options);
  add_golden(app, options);
  add_evaluate(app, options);
}

/// How long another solver may stay silent, and its settings.
void add_solver_options(CLI::App* command, Options& options) {
  command
      ->add_option("--seconds", options.patience, "Longest time without output during a call [s]")
      ->type_name("S")
      ->check(positive_number())
      ->capture_default_str();
  command
      ->add_option("--settings", options.overrides,
                   "Passed to the solver in every scene; may be given again")
      ->type_name("KEY=VALUE")
      ->check(some_text("KEY=VALUE"))
      ->allow_extra_args(false);
}

void add_judge(CLI::App& app, Options& options) {
  CLI::App* judge = add_command(
      app, options,
      {"judge", "Test another solver against laws that any cloth solver must meet", help::judge},
      judge_another_solver);
  judge->add_option("--solver", options.solver, "Command that starts the solver's adapter")
      ->type_name("CMD")
      ->check(some_text("a command"))
      ->required();
  judge->add_option("--name", options.name, "Name in the report (default: the solver's own)")
      ->type_name("NAME")
      ->check(some_text("a name"));
  judge
      ->add_option("--baseline", options.baseline,
                   "A kept verdicts.json of `judge`: fail only where the solver got worse since")
      ->type_name("FILE")
      ->check(some_text("a file"));
  add_solver_options(judge, options);
  add_out_if_typed(judge, options,
                   "Also write run.h5, verdicts.json, junit.xml and solver.json into this folder");
  add_json(judge, options);
  CLI::App* subject =
      add_command(app, options,
                  {"subject", "Test whether a solver's adapter keeps to the protocol of `judge`",
                   help::subject},
                  check_subject);
  subject->add_option("--check", options.solver, "Command that starts the adapter")
      ->type_name("CMD")
      ->check(some_text("a command"))
      ->required();
  add_solver_options(subject, options);
  CLI::App* served =
      add_command(app, options,
                  {"serve", "Answer the protocol of `judge` as the reference: `judge` starts this",
                   help::serve},
                  serve);
  served->add_option("--integrator", options.integrator, "One that `foldproof list` names")
      ->type_name("NAME")
      ->check(some_text("an integrator"))
      ->capture_default_str();
  served->add_option("--precision", options.precision, "Number format of its answers: f8 or f4")
      ->type_name("TYPE")
      ->check(one_of({"f8", "f4"}))
      ->capture_default_str();
}

/// Options that `campaign run` and `campaign emit` share with those who work for them.
void add_campaign_work(CLI::App* command, Options& options) {
  command->add_option("--slice", options.slice, "Jobs a slice; of `work`: the number of the slice")
      ->type_name("N")
      ->check(whole_number(0, 10'000'000));
  add_threads(command, options);
  add_cache(command, options);
  command
      ->add_option("--scratch", options.scratch,
                   "Folder on each node; results are copied to the store at the end of a slice")
      ->type_name("DIR")
      ->check(some_text("a folder"));
}

void add_campaign(CLI::App& app, Options& options) {
  CLI::App* campaign = app.add_subcommand(
      "campaign", "Run a case, or another command, over many parameters, here or on a cluster");
  campaign->group("Commands");
  campaign->require_subcommand(0, 1);
  campaign->footer(help::campaign);
  const auto add = [&](const CommandText& text, int (*run)(const Options&)) {
    CLI::App* command = add_command(*campaign, options, text, run);
    add_input(command, "FILE", options.file,
              "NAME.campaign.toml (cases/campaigns/README.md), or a shipped campaign");
    add_folder(command, options, "Folder whose store/ keeps every result")->capture_default_str();
    return command;
  };
  add({"plan", "How many jobs, how long, how many bytes? Runs a sample of three",
       help::campaign_plan},
      plan_campaign);
  CLI::App* run = add({"run", "Run what is missing", help::campaign_run}, run_campaign);
  run->add_option("--on", options.engine, "Engine: local or slurm")
      ->type_name("ENGINE")
      ->capture_default_str();
  run->add_option("--options", options.engine_options,
                  "Options for the engine's own command, as \"--partition=long --time=60\"")
      ->type_name("WORDS");
  add_campaign_work(run, options);
  add_json(add({"table", "Write table.csv and table.h5, and judge [expect]", help::campaign_table},
               show_campaign_table),
           options);
  add({"report", "Write a page of maps and curves", help::campaign_report}, report_campaign);
  add_json(add({"status", "Done, running, failed, missing", help::campaign_status},
               show_campaign_status),
           options);
  add({"watch", "Show the status until nothing runs", help::campaign_watch}, watch_campaign);
  add({"cancel", "Stop the running jobs of the campaign", help::campaign_cancel}, cancel_campaign);
  CLI::App* emit = add({"emit", "Print what is missing as commands, one a line, for another engine",
                        help::campaign_emit},
                       emit_campaign);
  emit->add_option("--slice", options.slice, "Jobs a line (default: 50)")
      ->type_name("N")
      ->check(whole_number(1, 10'000'000));
  CLI::App* work = add_command(
      *campaign, options,
      {"work", "Run a slice of a batch; engines start this", help::campaign_work}, work_on_batch);
  add_input(work, "BATCH", options.file, "Folder of the batch, DIR/store/batches/NAME");
  add_campaign_work(work, options);
}

int run(int argc, char** argv) {
  Options options;
  options.command = command_line(argc, argv);
  options.words.assign(argv, argv + argc);
  CLI::App app(
      "Verification suite and reference implementation for cloth simulation, after Bridson, "
      "Marino, Fedkiw (2003).");
  app.footer(help::whole_program);
  app.formatter(std::make_shared<PlainHelp>());
  app.require_subcommand(0, 1);  // a word that is none is named, rather than said to be missing
  app.set_version_flag("--version", [] {
    const Provenance p = provenance("");
    return fmt::format("foldproof {} ({}, {})", p.version, p.commit, p.tree);
  });
  add_runs(app, options);
  add_selections(app, options);
  add_readers(app, options);
  add_ablate(app, options);
  add_converge(app, options);
  add_precision(app, options);
  add_project(app, options);
  add_judge(app, options);
  add_campaign(app, options);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return end_parse(app, error);
  }
  if (!options.run) return reject_missing_command(app);
  return options.run(options);
}

}  // namespace
}  // namespace foldproof

int main(int argc, char** argv) {
  // a file that may grow no further is an error like a full disk, and told like one
  std::signal(SIGXFSZ, SIG_IGN);
  try {
    const int code = foldproof::run(argc, argv);
    if (std::fflush(stdout) == 0) return code;
    foldproof::log_line("foldproof: standard output cannot be written; is the disk full?");
  } catch (const std::bad_alloc&) {
    foldproof::log_line("foldproof: this takes more memory than there is");
  } catch (const std::exception& error) {
    const char* const where =
        std::ferror(stdout) ? "foldproof: standard output cannot be written: " : "foldproof: ";
    foldproof::log_line(std::string(where) + error.what());
  }
  return foldproof::bad_input;
}
