// The program. See `foldproof --help`.
#include <malloc.h>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <csignal>
#include <cstdio>
#include <memory>
#include <new>

#include "scripts/program/command_line/all_commands.h"
#include "scripts/program/command_line/command_line.h"
#include "scripts/program/commands.h"
#include "scripts/program/data_folder.h"
#include "scripts/program/command_line/help_texts.h"
#include "scripts/program/command_line/typed_command.h"
#include "scripts/program/progress.h"
#include "scripts/program/provenance.h"

namespace foldproof {
namespace {

std::string command_line(int argc, char** argv) {
  std::string command = program_command();
  for (int k = 1; k < argc; ++k) command += " " + shell_word(argv[k]);
  return command;
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
  add_smooth(app, options);
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
  // Memory that a step frees is kept for the next: to ask the system for it again takes a quarter
  // of a step's time at 100,000 particles.
  mallopt(M_MMAP_THRESHOLD, 1 << 30);
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
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
