// Measures what is expected of a case while it runs, and says what came of it.
#pragma once

#include <vector>

#include "verification/cases/expectations.h"
#include "verification/cases/quantities.h"

namespace foldproof {

/// Give it every row of diagnostics, every frame and every checkpoint of the run; then ask.
class CaseJudge {
 public:
  /// of: must outlive it.
  ///   objects      of the system that runs, which must outlive it
  ///   level_sets   for a system built anew; they should remember those that were made
  ///                (bodies/makers.h)
  CaseJudge(const Case& of, std::span<const Object> objects, const LevelSetMakers& level_sets)
      : case_(of), objects_(objects), repetition_(of.scene, level_sets), seen_(of.expectations.size()) {}

  void enter(const Diagnostics& row) {
    book_.enter(row, case_.scene.schedule.end);
    repetition_.enter(row);
  }
  void enter(const Checkpoint& at) { repetition_.enter(at); }
  void enter(const State& frame);

  /// One record for each expectation, named finding_name(...). Of a run that stopped, all but
  /// runs_to_its_end fail: nothing is known of what was to come. One that is not asked is not applicable, with
  /// the reason as its note.
  std::vector<Record> judged(const RunResult& result) const;

 private:
  Finding finding_of(size_t k, const RunSeen& run) const;

  const Case& case_;
  std::span<const Object> objects_;
  RunBook book_;
  Repetition repetition_;
  std::vector<Worst> seen_;  // largest over the frames, one for each expectation
};

/// "reason (step n, after t = ... s, particle i)".
std::string described(const Stop& stop);

}  // namespace foldproof
