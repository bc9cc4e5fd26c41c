// Tests whether a run repeats bit for bit: parts of it are rerun in a separate thread.
#pragma once

#include <vector>

#include "reference/bodies/level_set_provider.h"
#include "reference/dynamics/simulate.h"
#include "reference/scene/scene.h"

namespace foldproof {

/// Pass it every checkpoint and every row of diagnostics of a run, then call
/// count_differing_steps(). It keeps the state at the start, in the middle and before the last
/// frame, and the ten steps after each.
class Repetition {
 public:
  /// scene: must outlive it. level_sets: for the rebuilt system.
  Repetition(const Scene& scene, const LevelSetProvider& level_sets)
      : scene_(scene), level_sets_(level_sets) {}

  void record(const Checkpoint& at);
  void record(const Diagnostics& row);

  /// Resumes from the stored states with a rebuilt system, and counts the steps whose diagnostics
  /// (except clock time) differ in any bit or are missing. NaN if no step was seen.
  double count_differing_steps() const;

 private:
  struct Part {
    Checkpoint from;
    std::vector<Diagnostics> rows;
  };

  const Scene& scene_;
  LevelSetProvider level_sets_;
  std::vector<Part> parts_;
};

}  // namespace foldproof
