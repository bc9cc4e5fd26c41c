// The program: what can be typed, and nothing else. See `foldproof --help`.
#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <csignal>
#include <cstdio>
#include <new>

#include "scripts/program/commands.h"
#include "scripts/program/data_folder.h"
#include "scripts/program/progress.h"
#include "scripts/program/provenance.h"
#include "verification/oracles/golden.h"

namespace foldproof {
namespace {

constexpr const char* examples = R"(Examples:
  foldproof verify                                    everything of the quick tier, and the report results/report.html
  foldproof simulate hanging_sheet --set bending.stiffness=1e-3 --out results
  foldproof simulate any_mesh --set cloth.mesh=body.obj
  foldproof inspect body.obj                          is it closed, oriented, without intersections?
  foldproof simulate drape_statue --set object.mesh=body.obj --cache cache
  foldproof crossings results/fast.h5                 does the cloth pass through itself? Of OBJ files, too
  foldproof project results/half_inside.h5 --map blend --tau 0.01
  foldproof ablate grab                               which of its parts does this scene need?
  foldproof check bending                             all checks of bending
  foldproof check bending.forces-sum-to-zero --json   one of them, for another program
  foldproof study time-order.hinge                    one study
  foldproof claims                                    the paper's claims and their rulings in the last run
  foldproof claims B10                                one of them: why, and the findings that decide it
  foldproof evaluate bending hinges.csv               forces of your hinges, in 17 digits
Exit code: 0 all hold, 1 something fails, 2 bad input.)";

constexpr const char* evaluate_help =
    R"(Prints the bending forces of single hinges, to compare another code with. Each row of FILE has 27 comma-separated numbers:
  x1 x2 x3 x4 (12 position components [m]), v1 v2 v3 v4 (12 velocity components [m/s]), ke [J], kd [N s], theta0 [rad].
Output: 12 elastic and 12 damping force components [N] in 17 digits. The weight |E|^2/(|N1|+|N2|) is taken at the current positions, or, with --rest, at
the rest positions: rows of 12 numbers.)";

constexpr const char* golden_help =
    R"(Prints a heading, then rows of numbers in 17 digits; vectors are three columns, NAME_x, NAME_y, NAME_z. With --json also what each column
is, its unit, and the formula. All outputs were computed with 50 digits and rounded once. verification/GOLDEN.md has examples in Python
and C++.)";

constexpr const char* queries_help =
    R"(A row of FILE is a point: numerator and denominator of x, y and z, and 1 if the query meets, else 0, all whole numbers. Eight rows are a query: four
points at the start of a motion in straight lines, the same four at its end. vertex-face: the vertex, then the triangle's corners. edge-edge: the ends of the
first edge, then of the second. Exit code 1: the reference misses a meeting, or the exact judge does not agree with the file.)";

constexpr const char* ablate_help =
    R"(Runs the case as it is, with half the step, and with triangles of half the size: by how much that moves its particles is its own error. Then once
without each part that it names, and once with each that it does not name and that needs no numbers from its author: self-collision, strain limits, points between
particles. A part is needed, or missing, if without it particles move by more than the scene's own error, the run comes to no end, an expectation of the case
fails or has no meaning, the cloth crosses itself, or lies deeper in an object by more than that error. The table [ablation] of a case file may say why a part
is there, or left out, all the same; name a coarser mesh instead of a finer one that would take hours; and ask of the beginning of a long run only. Exit code 1
(and a mark !): a part is not needed, or one is missing, and the case does not say why; or it says so needlessly; or the scene itself comes to no end, or fails what
it expects.)";

constexpr const char* converge_help =
    R"(Runs the case as it is, then with every step halved, and halved again. For each quantity: the order by which differences
between levels fall, Richardson's limit, and the grid convergence index as error bar (safety 1.25 where the order has settled, else 3). Quantities are those of
the case's [[quantity]] tables; without any: positions, energies, heights, and what its [expect] asks. Exit code 1: the order of the positions is inconclusive.)";

constexpr const char* project_help =
    R"(Prints how many points were moved, and of the last frame how much of the wrinkles is left: the standard deviation of the depths of points that were
inside, and where the spectrum of the depth along a section of the cloth is largest, before, after plain projection, and after the map. Points between two
objects are left alone. Points end at most tau/10^6 farther out than the map says. Exit code 1: some points found no room between objects.)";

constexpr const char* case_words =
    "Case file (cases/KEYS.md), or a shipped case, as `foldproof list` names them";

std::string typed(int argc, char** argv) {
  std::string command = program_command();
  for (int k = 1; k < argc; ++k) command += std::string(" ") + argv[k];
  return command;
}

/// A command that runs `run` when it was typed.
CLI::App* add_command(CLI::App& app, Options& options, const std::string& name, const std::string& what,
                      int (*run)(const Options&)) {
  CLI::App* command = app.add_subcommand(name, what);
  command->callback([&options, run] { options.run = run; });
  return command;
}

void add_json(CLI::App* command, Options& options) {
  command->add_flag("--json", options.json, "Print JSON on standard output");
}

void add_tier(CLI::App* command, Options& options) {
  command->add_option("--tier", options.tier, "quick or full")
      ->check(CLI::IsMember({"quick", "full"}))
      ->capture_default_str();
}

void add_folder(CLI::App* command, Options& options, const std::string& what) {
  command->add_option("--out", options.out, what)->capture_default_str();
}

/// Level sets are kept only where a folder is named: a run leaves nothing behind that it was not asked for.
void add_cache(CLI::App* command, Options& options) {
  command->add_option(
      "--cache", options.cache,
      "Folder that keeps the level sets of meshes for later runs; the results are the same to the bit");
}

/// How checks, studies and cases are run, and on which samples.
void add_running(CLI::App* command, Options& options) {
  command
      ->add_option("--seed", options.seed_shift,
                   "Shifts the seeds of all random samples: 0 for those that the project is judged by")
      ->check(CLI::Range(0, 1'000'000'000))
      ->capture_default_str();
  command->add_option("--threads", options.running.threads, "Jobs at a time (default: one a core)");
  command->add_option("--order", options.running.order,
                      "Shuffles the jobs, each number in another way (default: the longest first)");
}

/// --out that has no value where it was not typed.
void add_out_if_typed(CLI::App* command, Options& options, const std::string& what) {
  command->add_option("--out", options.out, what);
  command->parse_complete_callback([&options, command] {
    if (command->count("--out") == 0) options.out = "";
  });
}

/// check and study: they write files only if a folder is named.
void add_selections(CLI::App& app, Options& options) {
  for (CLI::App* command :
       {add_command(app, options, "check", "Run checks (all, or those named)", run_checks),
        add_command(app, options, "study", "Run studies (all, or those named)", run_studies)}) {
    command->add_option("NAME", options.names, "Names or groups, as `foldproof list` shows them");
    add_out_if_typed(command, options, "Also write run.h5, verdicts.json and junit.xml into this folder");
    add_running(command, options);
    add_tier(command, options);
    add_json(command, options);
  }
}

void add_runs(CLI::App& app, Options& options) {
  CLI::App* simulate =
      add_command(app, options, "simulate", "Simulate a case; writes NAME.h5 and NAME.xdmf", simulate_case);
  simulate->add_option("CASE", options.file, case_words)->required();
  simulate->add_option("--set", options.overrides, "Override a key: table.key=value")
      ->allow_extra_args(false);
  CLI::Option* resume = simulate->add_flag(
      "--resume", options.resumes,
      "Go on from the last checkpoint of a run that was interrupted; the results are the same to the bit");
  simulate->add_flag("--restart", options.restarts,
                     "Start over, and delete the checkpoints of a run that was interrupted")
      ->excludes(resume);
  CLI::App* everything = add_command(app, options, "verify",
                                     "All checks, studies and cases, the claims, and the report", verify);
  everything->add_flag("--no-report", options.no_report, "Write the results only");
  everything->add_flag("--no-bench", options.no_bench, "Measure no speeds");
  add_running(everything, options);
  add_tier(everything, options);
  CLI::App* speed =
      add_command(app, options, "bench", "Measure speed and memory; writes bench.h5", run_bench);
  speed->add_flag("--quick", options.quick, "Up to 100k particles instead of a million");
  for (CLI::App* command : {simulate, everything}) add_cache(command, options);
  for (CLI::App* command : {simulate, everything, speed}) {
    add_folder(command, options, "Folder for results");
    add_json(command, options);
  }
}

void add_ablate(CLI::App& app, Options& options) {
  CLI::App* ablate =
      add_command(app, options, "ablate",
                  "Which of its parts does a case need, which does it lack, and what does "
                  "each cost? Writes ablation.json, where what this program found of other cases stays",
                  ::foldproof::ablate);
  ablate->footer(ablate_help);
  ablate->add_option("CASE", options.names, "Case files, or names of shipped cases (default: all of the tier)");
  add_tier(ablate, options);
  ablate->add_option("--set", options.overrides, "Override a key: table.key=value")->allow_extra_args(false);
  ablate->add_option("--threads", options.running.threads, "Runs at a time (default: one a core)");
  add_cache(ablate, options);
  add_folder(ablate, options, "Folder for ablation.json");
  add_json(ablate, options);
}

void add_project(CLI::App& app, Options& options) {
  CLI::App* project = add_command(
      app, options, "project", "Bring the cloth of a stored run out of its objects; writes NAME_projected.h5",
      project_run);
  project->footer(project_help);
  project->add_option("RUN.h5", options.file, "What `foldproof simulate` wrote")->required();
  project->add_option("--map", options.map, "Map of depth: plain, power or blend")
      ->check(CLI::IsMember({"plain", "power", "blend"}))
      ->required();
  project->add_option("--tau", options.reach, "Points up to so far outside are moved [m]")->required();
  project->add_option("--eps", options.eps, "How far out the deepest points come to lie [m]")
      ->capture_default_str();
  project->add_option(
      "--deepest", options.deepest,
      "Deepest penetration that is told from deeper ones [m] (default: the deepest in the run)");
  project->add_option("--subdivide", options.levels, "Levels of subdivision before the projection, 0 to 8")
      ->capture_default_str();
  project->add_option("--rule", options.rule, "Rule of subdivision: loop or midpoint")
      ->check(CLI::IsMember({"loop", "midpoint"}))
      ->capture_default_str();
  add_cache(project, options);
  add_folder(project, options, "Folder for the projected run");
  add_json(project, options);
}

/// What reports/ makes of stored results.
void add_pages(CLI::App& app, Options& options) {
  CLI::App* report =
      add_command(app, options, "report",
                  "Make DIR/report.html from stored results; of two folders, say what differs", make_report);
  report->add_option("DIR", options.names, "Folder with run.h5 or case files; two of them are compared")
      ->required()
      ->expected(1, 2);
  report->add_flag("--pdf", options.pdf, "Also DIR/report.pdf, printed by Chromium");
  report->add_flag("--papers", options.papers,
                   "Figures and pictures also as PDF and PNG files, in DIR/figures");
  CLI::App* film =
      add_command(app, options, "film", "Make a film of a stored run (MP4 and GIF, by ffmpeg)", make_film);
  film->add_option("RUN.h5", options.file, "What `foldproof simulate` wrote")->required();
  film->add_option("--field", options.field, "Colour the cloth by strain, angle, phi or speed");
  film->add_option("--size", options.size, "Pixels, such as 1280x720");
  film->add_option("--fps", options.fps, "Pictures a second");
  add_out_if_typed(film, options, "FILE.mp4 or FILE.gif (default: both, beside RUN.h5)");
  CLI::App* files = add_command(
      app, options, "export", "Write the frames of a stored run as files for other programs", export_frames);
  files->add_option("RUN.h5", options.file, "What `foldproof simulate` wrote")->required();
  files->add_option("--format", options.kind, "obj, ply or xdmf")
      ->check(CLI::IsMember({"obj", "ply", "xdmf"}))
      ->required();
  files->add_option("--out", options.out, "Folder for the files")->required();
}

void add_readers(CLI::App& app, Options& options) {
  add_json(add_command(app, options, "list", "What there is: checks, studies, cases, integrators", list),
           options);
  CLI::App* claims =
      add_command(app, options, "claims", "What a finished run says of the paper's claims", show_claims);
  claims->add_option("ID", options.names, "One claim, such as T17: why, and the findings that decide it");
  add_folder(claims, options, "Folder of the finished run");
  add_json(claims, options);
  add_pages(app, options);
  CLI::App* mesh = add_command(
      app, options, "inspect",
      "What a mesh is good for as a body; exit code 1: it is no solid, or opinions differ", inspect);
  mesh->add_option("MESH.obj", options.file, "An OBJ file")->required();
  mesh->add_option("--cells", options.cells, "Of the grid that is looked at, along the longest side")
      ->check(CLI::Range(4, 1000))
      ->capture_default_str();
  add_json(mesh, options);
  CLI::App* crossings = add_command(app, options, "crossings",
                                    "Edges and triangles of a cloth that meet, decided exactly, in every "
                                    "frame; exit code 1: there are some",
                                    show_crossings);
  crossings->add_option("FILE", options.names, "Stored runs (.h5), or meshes (.obj), each a frame")
      ->required();
  add_json(crossings, options);
  CLI::App* golden =
      add_command(app, options, "golden",
                  "Inputs and outputs of a formula, right to the last digit, for unit tests of yours",
                  print_golden_values);
  golden->footer(golden_help);
  golden
      ->add_option("TABLE", options.file,
                   "bending, springs, integrator, forecast, friction, projection, sticking")
      ->required()
      ->check(CLI::IsMember(golden_names()));
  golden->add_option("--count", options.count, "Rows")->check(CLI::PositiveNumber)->capture_default_str();
  golden->add_option("--seed", options.seed, "The same rows for the same number")->capture_default_str();
  add_json(golden, options);
  CLI::App* evaluate = app.add_subcommand("evaluate", "Evaluate a formula on your numbers");
  evaluate->require_subcommand(0, 1);
  CLI::App* bending =
      add_command(*evaluate, options, "bending", "Forces of single hinges from a CSV file", evaluate_hinges);
  bending->footer(evaluate_help);
  bending->add_option("FILE", options.file, "CSV, 27 columns")->required();
  bending->add_option("--rest", options.rest_file, "CSV, 12 columns: rest positions, for rest weighting");
  CLI::App* queries = add_command(
      *evaluate, options, "crossings",
      "Moving features that meet, or not: the reference and the exact judge against a file's word",
      evaluate_queries);
  queries->footer(queries_help);
  queries
      ->add_option("FILE,--ccd-data", options.file,
                   "CSV, 7 columns, 8 rows a query, or a folder of such files")
      ->required();
  queries->add_option("--kind", options.kind, "vertex-face or edge-edge; without it the path says which")
      ->check(CLI::IsMember({"vertex-face", "edge-edge"}));
  queries->add_option("--keep", options.keep, "What the reference is to keep apart [m]")
      ->capture_default_str();
}

void add_converge(CLI::App& app, Options& options) {
  CLI::App* command =
      add_command(app, options, "converge",
                  "How large is the error that a case owes to its step? Order, limit and error bar of its quantities",
                  converge);
  command->footer(converge_help);
  command->add_option("CASE", options.file, case_words)->required();
  command->add_option("--levels", options.levels, "Runs, each with half the steps of the one before")
      ->check(CLI::Range(3, 12))
      ->default_val(4);
  command->add_option("--method", options.methods, "Integrator in place of the case's own");
  command->add_option("--until", options.until, "Ask only the beginning of the run, up to this time [s]")
      ->check(CLI::PositiveNumber);
  command->add_option("--set", options.overrides, "Override a key: table.key=value")->allow_extra_args(false);
  add_folder(command, options, "Folder whose store/ keeps every run; a second call makes only what is missing");
  add_cache(command, options);
  command->add_option("--threads", options.running.threads, "Runs at a time (default: one a core)");
  add_json(command, options);
}

int run(int argc, char** argv) {
  Options options;
  options.command = typed(argc, argv);
  options.words.assign(argv, argv + argc);
  CLI::App app(
      "Verification suite and reference implementation for cloth simulation, after Bridson, Marino, Fedkiw "
      "(2003).");
  app.footer(examples);
  app.require_subcommand(0, 1);  // a word that is none is named, rather than said to be missing
  app.set_version_flag("--version", [] {
    const Provenance p = provenance("");
    return fmt::format("foldproof {} ({}, {})", p.version, p.commit, p.tree);
  });
  add_readers(app, options);
  add_runs(app, options);
  add_ablate(app, options);
  add_converge(app, options);
  add_project(app, options);
  add_selections(app, options);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? all_hold : bad_input;
  }
  if (!options.run) return app.exit(CLI::RequiredError("A subcommand")), bad_input;
  return options.run(options);
}

}  // namespace
}  // namespace foldproof

int main(int argc, char** argv) {
  std::signal(SIGXFSZ,
              SIG_IGN);  // a file that may grow no further is an error like a full disk, and told like one
  try {
    const int code = foldproof::run(argc, argv);
    if (std::fflush(stdout) == 0) return code;
    foldproof::say("foldproof: standard output cannot be written; is the disk full?");
  } catch (const std::bad_alloc&) {
    foldproof::say("foldproof: this takes more memory than there is");
  } catch (const std::exception& error) {
    const char* const where =
        std::ferror(stdout) ? "foldproof: standard output cannot be written: " : "foldproof: ";
    foldproof::say(std::string(where) + error.what());
  }
  return foldproof::bad_input;
}
