// foldproof converge --over and --runs: the map of errors over a solver's settings.
#pragma once

#include <string>
#include <vector>

#include "scripts/program/options.h"

namespace foldproof {

struct ConvergeOptions : Options {
  std::vector<std::string> over;  // tunables
  std::string runs;               // table of runs that were made elsewhere
  std::vector<double> at;         // the values in use; empty: those of the solver
};

/// The map over the tunables of --over, of another solver or of the reference; or of the runs in a
/// table. Returns the exit code.
int converge_settings(const ConvergeOptions& options);

}  // namespace foldproof
