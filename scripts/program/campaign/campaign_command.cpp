// foldproof campaign: a case, or another command, over many parameters.
#include "scripts/program/campaign/campaign_commands.h"
#include "scripts/program/command_line/options_of_commands.h"

namespace foldproof {

namespace {

/// Options that `campaign run` and `campaign emit` share with those who work for them.
void add_campaign_work(CLI::App* command, Options& options) {
  add_value(command, "--slice N", options.slice, "Jobs a slice; of `work`: the number of the slice",
            whole_number(0, 10'000'000));
  add_threads(command, options);
  add_cache(command, options);
  add_value(command, "--scratch DIR", options.scratch,
            "Folder on each node; results are copied to the store at the end of a slice",
            some_text("a folder"));
}

constexpr const char* below_campaign =
    R"(Examples:
  foldproof campaign plan mine.campaign.toml
  foldproof campaign run mine.campaign.toml            all cores; --on slurm: a cluster

Exit codes:
  0    as the command's own help says
  2    bad input)";

constexpr const char* below_plan =
    R"(Contacts no engine, and keeps no result of the sample.

Examples:
  foldproof campaign plan bending_atlas

Exit codes:
  0    planned
  2    bad input)";

constexpr const char* below_run =
    R"(Runs every job that has no result in the store: nothing is run twice, not even by two
campaigns. Failures are results. A killed job is started again, up to three times. After Ctrl-C the
same command resumes; a batch in a queue goes on without it.

Examples:
  foldproof campaign run bending_atlas --out mine
  foldproof campaign run bending_atlas --out mine --on slurm

Exit codes:
  0    every job has a result and holds
  1    a job failed, stopped, was refused or crashed; or a repetition found something else
  2    bad input, or a file that cannot be written
  130  interrupted by Ctrl-C (143: by SIGTERM))";

constexpr const char* below_table =
    R"(Writes DIR/campaigns/NAME/table.csv and table.h5, a row a job. DIR/store/index.sqlite answers SQL.

Examples:
  foldproof campaign table bending_atlas --out mine

Exit codes:
  0    written; everything in [expect] holds
  1    written; an expectation fails, or waits for jobs that have no result
  2    bad input, or a file that cannot be written)";

constexpr const char* below_report =
    R"(Needs the Debian packages python3-matplotlib and python3-jinja2. Writes
DIR/campaigns/NAME/report.html, with every [[figure]] of the campaign; failures are drawn as such.

Examples:
  foldproof campaign report bending_atlas --out mine

Exit codes:
  0    written; its path is printed
  2    bad input, or a package is missing)";

constexpr const char* below_status =
    R"(Examples:
  foldproof campaign status bending_atlas --out mine

Exit codes:
  0    every job has ended
  1    jobs run, or are missing
  2    bad input)";

constexpr const char* below_watch =
    R"(Prints a line every two seconds, and keeps DIR/campaigns/NAME/watch.html, which refreshes itself.

Examples:
  foldproof campaign watch bending_atlas --out mine

Exit codes:
  0    nothing runs any more, and every job has ended
  1    nothing runs any more, and jobs are missing
  2    bad input)";

constexpr const char* below_cancel =
    R"(Examples:
  foldproof campaign cancel bending_atlas --out mine

Exit codes:
  0    cancelled, or nothing ran
  2    bad input; the engine refuses, or it runs on another machine)";

constexpr const char* below_emit =
    R"(Prints one command for each slice of missing jobs. They may run anywhere that sees the store, in any
order, and more than once. Afterwards the other commands find their results.

Examples:
  foldproof campaign emit bending_atlas --out mine

Exit codes:
  0    printed
  2    bad input, or a file that cannot be written)";

constexpr const char* below_work =
    R"(Runs the jobs of its slice that have no result, on --threads processes. Refuses a batch that another
build of the program planned.

Examples:
  foldproof campaign work mine/store/batches/NAME --slice 0 --threads 1

Exit codes:
  0    every job of the slice has a result
  1    some have none
  2    bad input, or results that cannot be written)";

}  // namespace

void add_campaign_command(CLI::App& app, Program& program) {
  CLI::App* campaign = add_subcommand(
      app,
      {"campaign", "Run a case, or another command, over many parameters, here or on a cluster",
       below_campaign});
  campaign->require_subcommand(0, 1);
  const auto add = [&](const CommandText& text, int (*run)(const Options&)) {
    const Command<Options> added = add_command(*campaign, program, text, run);
    add_input(added.app, "FILE", added.options.file,
              "NAME.campaign.toml (cases/campaigns/README.md), or a shipped campaign");
    add_folder(added.app, added.options, "Folder whose store/ keeps every result")
        ->capture_default_str();
    return added;
  };
  add({"plan", "How many jobs, how long, how many bytes? Runs a sample of three", below_plan},
      plan_campaign);
  auto [run, options] = add({"run", "Run what is missing", below_run}, run_campaign);
  add_value(run, "--on ENGINE", options.engine, "Engine: local or slurm")->capture_default_str();
  add_value(run, "--options WORDS", options.engine_options,
            "Options for the engine's own command, as \"--partition=long --time=60\"");
  add_campaign_work(run, options);
  const auto table = add({"table", "Write table.csv and table.h5, and judge [expect]", below_table},
                         show_campaign_table);
  add_json(table.app, table.options);
  add({"report", "Write a page of maps and curves", below_report}, report_campaign);
  const auto status =
      add({"status", "Done, running, failed, missing", below_status}, show_campaign_status);
  add_json(status.app, status.options);
  add({"watch", "Show the status until nothing runs", below_watch}, watch_campaign);
  add({"cancel", "Stop the running jobs of the campaign", below_cancel}, cancel_campaign);
  auto [emit, of_emit] =
      add({"emit", "Print what is missing as commands, one a line, for another engine", below_emit},
          emit_campaign);
  add_value(emit, "--slice N", of_emit.slice, "Jobs a line (default: 50)",
            whole_number(1, 10'000'000));
  auto [work, of_work] = add_command(
      *campaign, program, {"work", "Run a slice of a batch; engines start this", below_work},
      work_on_batch);
  add_input(work, "BATCH", of_work.file, "Folder of the batch, DIR/store/batches/NAME");
  add_campaign_work(work, of_work);
}

}  // namespace foldproof
