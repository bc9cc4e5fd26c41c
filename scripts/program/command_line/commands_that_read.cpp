// Commands that read stored results, meshes and numbers: what can be typed.
#include "scripts/program/command_line/all_commands.h"
#include "scripts/program/command_line/help_texts.h"
#include "scripts/program/command_line/options_of_commands.h"
#include "verification/oracles/golden.h"

namespace foldproof {
namespace {

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
  add_switch(report, "--one-file", options.one_file,
             "Write everything into DIR/report.html, without the pages of DIR/report");
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
  add_frame_times(compare, options);
  add_cache(compare, options);
  add_out_if_typed(compare, options, "Also write run.h5 into this folder, for `foldproof report`");
  add_json(compare, options);
}

}  // namespace

void add_readers(CLI::App& app, Options& options) {
  CLI::App* names = add_command(
      app, options,
      {"list", "Show what there is: checks, studies, laws, cases, claims", help::list}, list);
  names->add_option("KIND", options.kind, "The names of one kind; without it, how many there are")
      ->check(CLI::IsMember(
          {"checks", "studies", "laws", "frame-laws", "cases", "claims", "integrators"}));
  add_json(names, options);
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

}  // namespace foldproof
