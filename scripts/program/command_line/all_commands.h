// Every command, by groups: each function adds some to the program.
#pragma once

#include <CLI/CLI.hpp>

#include "scripts/program/commands.h"

namespace foldproof {

void add_runs(CLI::App& app, Options& options);
void add_selections(CLI::App& app, Options& options);
void add_readers(CLI::App& app, Options& options);
void add_ablate(CLI::App& app, Options& options);
void add_converge(CLI::App& app, Options& options);
void add_precision(CLI::App& app, Options& options);
void add_project(CLI::App& app, Options& options);
void add_smooth(CLI::App& app, Options& options);
void add_judge(CLI::App& app, Options& options);
void add_campaign(CLI::App& app, Options& options);

}  // namespace foldproof
