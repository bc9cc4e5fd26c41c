// Does a run repeat itself to the bit? Parts of it are run again, in a thread of their own.
#pragma once

#include <vector>

#include "reference/bodies/level_set_provider.h"
#include "reference/dynamics/simulate.h"
#include "reference/scene/scene.h"

namespace foldproof {

/// Give it every checkpoint and every row of diagnostics of a run; then ask. It keeps the state at
/// the start, in the middle and before the last frame, and the ten steps after each.
class Repetition {
 public:
  /// scene: must outlive it. level_sets: of the system built anew.
  Repetition(const Scene& scene, const LevelSetProvider& level_sets)
      : scene_(scene), level_sets_(level_sets) {}

  void record(const Checkpoint& at);
  void record(const Diagnostics& row);

  /// Goes on from the kept states anew, with a system built anew, and counts the steps whose
  /// diagnostics have other bits than before, clock time apart, and those that are missing. NaN if
  /// no step was seen.
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
