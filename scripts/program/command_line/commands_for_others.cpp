// Commands for other solvers and for campaigns: what can be typed.
#include "scripts/program/command_line/all_commands.h"
#include "scripts/program/command_line/help_texts.h"
#include "scripts/program/command_line/options_of_commands.h"
#include "scripts/program/campaign/campaign_commands.h"

namespace foldproof {
namespace {

/// Frames instead of a solver.
void add_judged_frames(CLI::App* judge, CLI::Option* solver, Options& options) {
  CLI::Option* frames =
      judge->add_option("--frames", options.frames,
                        "Instead of a solver: folder of its OBJ or PLY files, one a frame");
  frames->type_name("DIR")->check(some_text("a folder"))->excludes(solver);
  CLI::Option* of = judge->add_option("--case", options.file,
                                      std::string("The case of the frames. ") + case_words);
  of->type_name("CASE")->check(some_text("a case"))->needs(frames);
  for (CLI::Option* time : add_frame_times(judge, options)) time->needs(frames);
  add_overrides(judge, options);
  add_cache(judge, options);
  for (const char* of_a_case : {"--set", "--cache"}) judge->get_option(of_a_case)->needs(frames);
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

}  // namespace

void add_judge(CLI::App& app, Options& options) {
  CLI::App* judge = add_command(
      app, options, {"judge", "Test another solver against the laws of cloth", help::judge},
      judge_another_solver);
  CLI::Option* solver =
      judge->add_option("--solver", options.solver, "Command that starts the solver's adapter");
  solver->type_name("CMD")->check(some_text("a command"));
  judge
      ->add_option("LAW", options.names,
                   "Laws or groups to judge, as `foldproof list laws` shows them")
      ->needs(solver);
  add_judged_frames(judge, solver, options);
  judge->add_option("--name", options.name, "Name in the report (default: the solver's own)")
      ->type_name("NAME")
      ->check(some_text("a name"));
  judge
      ->add_option("--baseline", options.baseline,
                   "A kept verdicts.json of `judge`: fail only where the solver got worse since")
      ->type_name("FILE")
      ->check(some_text("a file"));
  add_solver_options(judge, options);
  judge->get_option("--settings")->needs("--solver");
  judge
      ->add_option("--total-seconds", options.total_seconds,
                   "Longest time of all laws together [s] (default: no limit); laws that it does "
                   "not reach did not run")
      ->type_name("S")
      ->check(positive_number())
      ->needs(solver);
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
  served->add_option("--integrator", options.integrator, "One of `foldproof list integrators`")
      ->type_name("NAME")
      ->check(some_text("an integrator"))
      ->capture_default_str();
  served->add_option("--precision", options.precision, "Number format of its answers: f8 or f4")
      ->type_name("TYPE")
      ->check(one_of({"f8", "f4"}))
      ->capture_default_str();
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

}  // namespace foldproof
