// Options that several commands share, how a command is added, and the headers that most need.
#pragma once

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "scripts/program/command_line/command_line.h"
#include "scripts/program/options.h"

namespace foldproof {

constexpr const char* case_words =
    "Case file, NAME.toml (cases/KEYS.md), or a shipped case, as `foldproof list` names them";

/// A command as its help shows it: `what` it does in a line, and what stands below its options.
struct CommandText {
  const char* name;
  const char* what;
  const char* below;
};

/// A command and the options that its words set.
template <class Own>
struct Command {
  CLI::App* app;
  Own& options;
};

CLI::App* add_subcommand(CLI::App& app, const CommandText& text);

/// A command that runs `run` when it was typed. Own: Options, or a struct derived from it that
/// holds what this command alone can be told.
template <class Own>
Command<Own> add_command(CLI::App& app, Program& program, const CommandText& text,
                         int (*run)(const Own&)) {
  CLI::App* command = add_subcommand(app, text);
  const auto options = std::make_shared<Own>();
  command->callback([&program, options, run] {
    options->command = program.command;
    options->words = program.words;
    program.run = [options, run] { return run(*options); };
  });
  return {command, *options};
}

/// An option with a value, "--name TYPE".
template <class Value>
CLI::Option* add_value(CLI::App* command, const std::string& name_and_type, Value& value,
                       const std::string& what) {
  const size_t blank = name_and_type.find(' ');
  return command->add_option(name_and_type.substr(0, blank), value, what)
      ->type_name(name_and_type.substr(blank + 1));
}
template <class Value, class Check>
CLI::Option* add_value(CLI::App* command, const std::string& name_and_type, Value& value,
                       const std::string& what, const Check& check) {
  return add_value(command, name_and_type, value, what)->check(check);
}

void add_json(CLI::App* command, Options& options);

/// --seams, the distance within which vertices are joined [m].
void add_seams(CLI::App* command, double& distance);

CLI::Option* add_switch(CLI::App* command, const std::string& name, bool& value,
                        const std::string& what);

/// Input files that a command needs.
template <class Files>
CLI::Option* add_input(CLI::App* command, const std::string& name, Files& files,
                       const std::string& what) {
  return command->add_option(name, files, what)->check(some_text("a file or folder"))->required();
}

CLI::Option* add_folder(CLI::App* command, Options& options, const std::string& what);

void add_tier(CLI::App* command, Options& options);

void add_overrides(CLI::App* command, Options& options);

/// Level sets are kept only where a folder is named: a run leaves nothing behind that it
/// was not asked for.
void add_cache(CLI::App* command, Options& options);

/// When frames of another program are; returned: the options, which belong together.
std::vector<CLI::Option*> add_frame_times(CLI::App* command, Options& options);

inline const std::string jobs_at_a_time = "Jobs at a time (default: one a core)";
void add_threads(CLI::App* command, Options& options, const std::string& what = jobs_at_a_time);

/// How checks, studies and cases are run, and on which samples.
void add_running(CLI::App* command, Options& options);

/// --resume and --restart.
void add_resuming(CLI::App* command, Options& options);

/// --out that has no value where it was not typed.
void add_out_if_typed(CLI::App* command, Options& options, const std::string& what);

/// How long another solver may stay silent, and its settings.
void add_solver_options(CLI::App* command, Options& options);

CLI::Option* add_length(CLI::App* command, const std::string& name, double& value,
                        const std::string& what);

/// Integrators to run; `usual` are those of a command without the option.
void add_method(CLI::App* command, Options& options, const std::string& usual);

void add_errors(CLI::App* command, Options& options, const std::string& what);

/// Another solver, whose steps are halved beside the reference's.
CLI::Option* add_other_solver(CLI::App* command, Options& options, const std::string& words);

}  // namespace foldproof
