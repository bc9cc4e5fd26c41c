#include "scripts/program/judge/trial_output.h"

#include <fmt/format.h>

#include <cstdio>
#include <utility>

#include "scripts/program/listing.h"
#include "scripts/program/run_all.h"
#include "verification/files/atomic_file.h"
#include "verification/files/verdicts_file.h"

namespace foldproof {

namespace {

std::string changes_text(const BaselineChanges& changes) {
  std::string text;
  for (const auto& [word, lines] : {std::pair("worse", &changes.worse),
                                    {"better", &changes.better},
                                    {"neither worse nor better", &changes.other}})
    for (const std::string& line : *lines) text += fmt::format("{}: {}\n", word, line);
  const std::string other =
      changes.other.empty() ? "" : fmt::format(", {} neither", changes.other.size());
  return text + fmt::format("against the baseline: {} worse, {} better{}\n", changes.worse.size(),
                            changes.better.size(), other);
}

void write_results(const std::string& folder, const TrialOutput& trial,
                   const std::optional<BaselineChanges>& changes) {
  if (folder.empty()) return;
  write_run(folder + "/run.h5", trial.run);
  if (changes)
    write_verdicts_since(folder, trial.run, *changes);
  else
    write_verdicts(folder, trial.run);
  write_text(folder + "/solver.json", trial.facts);
}

}  // namespace

std::optional<Baseline> baseline_of(const Options& options) {
  if (options.baseline.empty()) return {};
  return read_baseline(options.baseline);
}

int finish_trial(const TrialOutput& trial, const std::optional<Baseline>& baseline,
                 const Options& options) {
  const RunRecord& run = trial.run;
  std::optional<BaselineChanges> changes;
  if (baseline) changes = changes_since(*baseline, run);
  write_results(options.out, trial, changes);
  if (options.json)
    fmt::print("{}", verdicts_json(run));
  else
    fmt::print("{}{}{}{}\n", trial.heading, listing(run), trial.below, summary(run));
  if (!changes) return exit_code(run);
  fmt::print(options.json ? stderr : stdout, "{}", changes_text(*changes));
  return changes->worse.empty() ? all_hold : some_fail;
}

}  // namespace foldproof
