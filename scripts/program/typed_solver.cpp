#include "scripts/program/typed_solver.h"

#include <fmt/format.h>

namespace foldproof {

SolverCommand solver_command(const Options& options) {
  SolverCommand command;
  command.command = options.solver;
  command.limits.seconds = options.patience;
  for (const std::string& setting : options.settings) {
    const size_t equals = setting.find('=');
    if (equals == std::string::npos || equals == 0)
      throw InputError(
          fmt::format("--settings {}: write KEY=VALUE, such as iterations=20", setting));
    command.settings.emplace_back(setting.substr(0, equals), setting.substr(equals + 1));
  }
  return command;
}

}  // namespace foldproof
