// Follows the trial of another solver: prints each law as it ends, and keeps its result.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "scripts/program/kept_results.h"
#include "scripts/program/options.h"
#include "verification/subjects/suite/laws.h"

namespace foldproof {

/// The laws of these names, groups or beginnings of names (all if there is none), without those of
/// `skipped`; smoke laws first, then quick ones, then slow ones by their size. Throws InputError
/// for a name that chooses nothing, with the nearest known ones.
std::vector<Law> chosen_laws(const std::vector<std::string>& names,
                             const std::vector<std::string>& skipped);

/// Whether `wanted` is the law's name, its group, or how its name begins.
bool chooses_law(const std::string& wanted, const std::string& name);

/// A solver of 2 ms a step of up to 400 particles takes so long for what was asked [s].
double seconds_of_a_numpy_solver(const Observed& asked);

/// Lines on standard error before and after each law, and results that outlive an interrupted
/// trial.
class TrialProgress {
 public:
  /// Throws InputError as KeptResults does.
  TrialProgress(const Options& options, const std::vector<Law>& laws);

  /// For judge_solver; this must outlive it.
  TrialWatch watch();

  /// "12 quick laws asked ...", of those that were asked now.
  std::string asked_text() const;

 private:
  void tell_size(const Law& law) const;
  void end_law(const Record& record, const Observed& asked);
  void dump(const Law& law, const PortableScene& scene, long steps, const Snapshot& now);
  void end_dump();

  const Options& options_;
  KeptResults kept_;
  std::string key_;  // of what a kept result depends on, besides the law
  std::map<std::string, Observed> asked_;
  double seconds_ = 0, particle_steps_ = 0, steps_ = 0;  // of the laws so far

  struct {
    std::string law = {};
    long number = 0, steps = 0;  // number: of the scene; 0: none
    PortableScene scene = {};
    Snapshot now = {};
  } dumped_;
};

}  // namespace foldproof
