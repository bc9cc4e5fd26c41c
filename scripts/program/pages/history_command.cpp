// foldproof history: what changed over several runs.
#include "scripts/program/command_line/options_of_commands.h"
#include "scripts/program/pages/report_script.h"

namespace foldproof {

namespace {

struct HistoryOptions : Options {
  std::string log;  // file of JSON lines
};

int show_history(const HistoryOptions& options) {
  std::vector<std::string> arguments = options.names;
  add_option(arguments, "--log", options.log);
  add_option(arguments, "--out", options.out);
  if (options.json) arguments.push_back("--json");
  return run_report_script("history", "make_history.py", arguments, true);
}

constexpr const char* below_history =
    R"(Needs the Debian packages python3-h5py, python3-matplotlib and python3-jinja2.

Examples:
  foldproof history results-monday results             what changed from one run to the next
  foldproof history results --log history.jsonl        append this run to a log, then show it

Exit codes:
  0    every finding that held before still holds in the newest run
  1    a finding that held before no longer holds
  2    bad input, or a package is missing)";

}  // namespace

void add_history_command(CLI::App& app, Program& program) {
  auto [history, options] = add_command(
      app, program,
      {"history", "Show what changed over several runs, and in which run first", below_history},
      show_history);
  history
      ->add_option("DIR", options.names, "Folders of finished runs, or their verdicts.json files")
      ->check(some_text("a file or folder"));
  add_value(history, "--log FILE", options.log,
            "Log in JSON lines, one a run: append the given runs, then show all of them",
            some_text("a file"));
  add_out_if_typed(history, options, "Also write a page to this file");
  history->get_option("--out")->type_name("FILE");
  add_json(history, options);
}

}  // namespace foldproof
