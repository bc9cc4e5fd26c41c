// foldproof report: pages from stored results.
#include "scripts/program/command_line/options_of_commands.h"
#include "scripts/program/command_line/typed_words.h"
#include "scripts/program/interruption.h"
#include "scripts/program/pages/report_script.h"

namespace foldproof {

namespace {

struct ReportOptions : Options {
  bool pdf = false, papers = false, summary = false, one_file = false;
};

int make_report(const ReportOptions& options) {
  const InterruptionNotice notice("the report is not written", typed_again(options.words));
  std::vector<std::string> arguments = options.names;
  if (options.pdf) arguments.push_back("--pdf");
  if (options.papers) arguments.push_back("--papers");
  if (options.one_file) arguments.push_back("--one-file");
  if (options.summary) arguments.push_back("--summary");
  return run_report_script("report", "make_report.py", arguments);
}

constexpr const char* below_report =
    R"(Needs the Debian packages python3-h5py, python3-matplotlib and python3-jinja2; --pdf also chromium.
Folders that `judge --out` wrote become one page of laws by solvers, compare.html in the last of
them, with its numbers in compare.json.

Examples:
  foldproof report results --summary                   one page: what was tested, what holds
  foldproof report results mine                        what differs: mine/compare.html

Exit codes:
  0    written; its path is printed
  2    there is nothing to report on, it cannot be read, or a package is missing)";

}  // namespace

void add_report_command(CLI::App& app, Program& program) {
  auto [report, options] = add_command(
      app, program,
      {"report", "Make DIR/report.html from stored results, or compare folders", below_report},
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
}

}  // namespace foldproof
