// foldproof results: bundles of judged solvers, and the pages on which they stand.
#include "scripts/program/command_line/options_of_commands.h"
#include "scripts/program/pages/report_script.h"

namespace foldproof {

namespace {

struct ResultsOptions : Options {
  std::string action, in;
};

int handle_results(const ResultsOptions& options) {
  std::vector<std::string> arguments = {options.action};
  arguments.insert(arguments.end(), options.names.begin(), options.names.end());
  add_option(arguments, "--in", options.in);
  return run_report_script("results", "make_results.py", arguments);
}

constexpr const char* below_results =
    R"(add   checks bundles of `judge --bundle` and copies them into the folder of --in; runs nothing of
      theirs. A digest shows damage, not who wrote a bundle: it stays *submitted* until a second one
      of the same adapter, version and settings agrees within its spread.
site  writes pages of all bundles of --in into DIR: engines by groups of laws, and their versions.

Examples:
  foldproof results add mine.bundle.json --in standing
  foldproof results site pages --in standing

Exit codes:
  0    added, or written
  2    a bundle is refused, with the reason, or a package is missing)";

}  // namespace

void add_results_command(CLI::App& app, Program& program) {
  auto [results, options] = add_command(
      app, program,
      {"results", "Collect bundles of judged solvers, and make pages of them", below_results},
      handle_results);
  results->add_option("ACTION", options.action, "add or site")
      ->check(one_of({"add", "site"}))
      ->required();
  add_input(results, "PATH", options.names, "Of add: bundles; of site: the folder to write");
  add_value(results, "--in DIR", options.in,
            "Folder that keeps the bundles (default: those that foldproof ships)",
            some_text("a folder"));
}

}  // namespace foldproof
