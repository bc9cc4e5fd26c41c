// The program. See `foldproof --help`.
#include <malloc.h>

#include <csignal>
#include <cstdio>
#include <new>

#include "scripts/program/command_line/options_of_commands.h"
#include "scripts/program/command_line/command_line.h"
#include "scripts/program/data_folder.h"
#include "scripts/program/command_line/typed_words.h"
#include "scripts/program/progress.h"
#include "scripts/program/provenance.h"

namespace foldproof {

void add_all_commands(CLI::App& app, Program& program);  // the build lists *_command.cpp

namespace {

constexpr const char* examples =
    R"(Examples:
  foldproof verify                                     the quick tier, and results/report.html
  foldproof simulate hanging_sheet                     one case, into results/
  foldproof check bending                              all checks of bending
  foldproof list                                       what there is: checks, laws, cases, claims
`foldproof COMMAND --help` explains a command, with examples.

Exit codes:
  0    everything holds
  1    something fails
  2    bad input, or a file that cannot be read or written
  130  ended by Ctrl-C (143: by SIGTERM))";

std::string command_line(int argc, char** argv) {
  std::string command = program_command();
  for (int k = 1; k < argc; ++k) command += " " + shell_word(argv[k]);
  return command;
}

int run(int argc, char** argv) {
  Program program{command_line(argc, argv), {argv, argv + argc}, nullptr};
  CLI::App app(
      "Verification suite and reference implementation for cloth simulation, after Bridson, "
      "Marino, Fedkiw (2003).");
  app.footer(examples);
  app.formatter(std::make_shared<PlainHelp>());
  app.require_subcommand(0, 1);  // a word that is none is named, rather than said to be missing
  app.set_version_flag("--version", [] {
    const Provenance p = provenance("");
    return fmt::format("foldproof {} ({}, {})", p.version, p.commit, p.tree);
  });
  add_all_commands(app, program);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return end_parse(app, error);
  }
  if (!program.run) return reject_missing_command(app);
  return program.run();
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
