// Options that several commands share, and how a command is added.
#pragma once

#include <CLI/CLI.hpp>

#include <string>

#include "scripts/program/command_line/command_line.h"
#include "scripts/program/commands.h"

namespace foldproof {

constexpr const char* case_words =
    "Case file, NAME.toml (cases/KEYS.md), or a shipped case, as `foldproof list` names them";

/// A command as its help shows it: `what` it does in a line, and what stands below its options.
struct CommandText {
  const char* name;
  const char* what;
  const char* below;
};

/// A command that runs `run` when it was typed.
CLI::App* add_command(CLI::App& app, Options& options, const CommandText& text,
                      int (*run)(const Options&));

void add_json(CLI::App* command, Options& options);

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

/// --out that has no value where it was not typed.
void add_out_if_typed(CLI::App* command, Options& options, const std::string& what);

CLI::Option* add_length(CLI::App* command, const std::string& name, double& value,
                        const std::string& what);

}  // namespace foldproof
