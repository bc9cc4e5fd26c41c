// Commands that run checks and cases: what can be typed.
#include "scripts/program/command_line/all_commands.h"
#include "scripts/program/command_line/help_texts.h"
#include "scripts/program/command_line/options_of_commands.h"

namespace foldproof {
namespace {

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
  add_threads(simulate, options,
              "Threads of the run; the results are the same to the bit (default: one a core, fewer "
              "in small scenes)");
  add_cache(simulate, options);
  add_folder(simulate, options, "Folder for results")->capture_default_str();
  add_json(simulate, options);
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

}  // namespace

/// check and study: they write files only if a folder is named.
void add_selections(CLI::App& app, Options& options) {
  for (CLI::App* command :
       {add_command(app, options, {"check", "Run checks (all, or those named)", help::check},
                    run_checks),
        add_command(app, options, {"study", "Run studies (all, or those named)", help::study},
                    run_studies)}) {
    command->add_option("NAME", options.names,
                        "Names or groups, as `foldproof list checks` shows them");
    add_out_if_typed(command, options,
                     "Also write run.h5, verdicts.json and junit.xml into this folder");
    add_running(command, options);
    add_tier(command, options);
    add_json(command, options);
  }
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
  ablate
      ->add_option("--mesh-levels", options.mesh_levels,
                   "Meshes that measure the mesh's error, 2 to 5; each takes about ten times as "
                   "long as the one before")
      ->type_name("N")
      ->check(whole_number(2, 5))
      ->capture_default_str();
  add_tier(ablate, options);
  add_overrides(ablate, options);
  add_threads(ablate, options);
  add_cache(ablate, options);
  add_folder(ablate, options, "Folder for ablation.json")->capture_default_str();
  add_json(ablate, options);
}

/// Another solver, whose steps are halved beside the reference's.
CLI::Option* add_other_solver(CLI::App* command, Options& options, const std::string& words) {
  CLI::Option* solver = command->add_option("--solver", options.solver, words)
                            ->type_name("CMD")
                            ->check(some_text("a command"));
  add_solver_options(command, options);
  for (const char* of_solver : {"--seconds", "--settings"})
    command->get_option(of_solver)->needs("--solver");
  return solver;
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
  add_other_solver(converge, options,
                   "Also halve the steps of another solver, started by this command")
      ->excludes("--in")
      ->excludes("--refine-objects");
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
  add_other_solver(precision, options,
                   "Also find the steps of another solver, started by this command");
  add_folder(precision, options,
             "Folder for precision.h5; its store/ keeps every run, and a second call makes only "
             "what is missing")
      ->capture_default_str();
  add_cache(precision, options);
  add_threads(precision, options);
  add_json(precision, options);
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

void add_smooth(CLI::App& app, Options& options) {
  CLI::App* smooth = add_command(
      app, options,
      {"smooth", "Give the cloth of a stored run a smooth surface; writes NAME_smooth.h5",
       help::smooth},
      smooth_run);
  add_input(smooth, "RUN.h5", options.file, "Run stored by `foldproof simulate`");
  smooth->add_option("--levels", options.smooth_levels, "Levels of subdivision, 1 to 4")
      ->type_name("N")
      ->check(whole_number(1, 4))
      ->capture_default_str();
  add_cache(smooth, options);
  add_folder(smooth, options, "Folder for the smooth run")->capture_default_str();
  add_json(smooth, options);
}

}  // namespace foldproof
