// Measures the expected quantities of a case while it runs, and judges them.
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
  ///   level_sets   for a rebuilt system; should be memoizing
  ///                (bodies/level_set_provider.h)
  CaseJudge(const Case& of, std::span<const Object> objects, const LevelSetProvider& level_sets)
      : case_(of),
        objects_(objects),
        repetition_(of.scene, level_sets),
        observed_(of.expectations.size()) {}

  void record(const Diagnostics& row) {
    summary_.record(row, case_.scene.schedule.end);
    repetition_.record(row);
  }
  void record(const Checkpoint& at) { repetition_.record(at); }
  void record(const State& frame);

  /// One record for each expectation, named finding_name(...). If the run stopped, all but
  /// runs_to_its_end fail, because the rest of it is unknown. An expectation that does not apply is
  /// recorded as not applicable, with the reason as its note.
  std::vector<Record> records(const RunResult& result) const;

 private:
  Finding finding_of(size_t k, const RunView& run) const;
  void watch_hinges(const State& frame);

  const Case& case_;
  std::span<const Object> objects_;
  DiagnosticsSummary summary_;
  Repetition repetition_;
  std::vector<Worst> observed_;  // largest over the frames, one for each expectation
  std::vector<double> angles_;   // of the hinges in the latest frame [rad]
  long folded_through_ = 0;      // hinges that passed 180 degrees from one frame to the next
};

/// "reason (step n, after t = ... s, particle i)".
std::string describe(const Stop& stop);

}  // namespace foldproof
