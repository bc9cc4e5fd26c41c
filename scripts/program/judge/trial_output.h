// What `judge` prints and writes, whether a solver was asked or its frames were read.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scripts/program/options.h"
#include "verification/files/baseline_file.h"
#include "verification/files/results_file.h"

namespace foldproof {

struct TrialOutput {
  RunRecord run;
  std::string facts;           // of solver.json
  std::string heading, below;  // text above the table of laws, and below it
};

/// The kept verdicts of --baseline, if it was typed.
std::optional<Baseline> baseline_of(const Options& options);

/// Writes the folder of --out, prints, compares with the baseline; returns the exit code.
int finish_trial(const TrialOutput& trial, const std::optional<Baseline>& baseline,
                 const Options& options);

}  // namespace foldproof
