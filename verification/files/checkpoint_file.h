// Checkpoints of a simulation: a folder of small HDF5 files, one a frame, from which an
// interrupted run goes on.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "reference/dynamics/simulate.h"
#include "reference/scene/scene.h"

namespace foldproof {

/// What a run's bits depend on. Checkpoints of one run are never mixed with another's.
struct RunIdentity {
  std::string case_text;  // with its overrides
  std::string meshes;     // key of all that was read beside the case file
  std::string program;    // its version, and a key of its code
};

RunIdentity identity_of(const Scene& scene, const std::string& program);

/// What lies between two checkpoints: the frame, which is the latest state of `at`, and the rows
/// since the one before.
struct CheckpointRecord {
  Checkpoint at;
  std::vector<Diagnostics> rows;
};

/// How far the run had come whose checkpoints lie in a folder.
struct KeptRun {
  long frame = -1;  // of the last checkpoint that is whole; -1: none is
  double time = 0;  // of that frame [s]
  // what it is of, where that is not what is asked for; "" if it can be resumed
  std::string differs;
};

/// Files 000000.h5, 000001.h5, ... in a folder of their own, each renamed when whole. Each holds
/// only what has happened since the one before, so that a run writes as much as its frames are
/// long; they are of use as far as none is missing.
class CheckpointFolder {
 public:
  /// Makes nothing yet.
  CheckpointFolder(std::string folder, RunIdentity identity);

  /// Makes the folder if it is not there. Throws std::runtime_error naming the file.
  void write(const CheckpointRecord& record) const;

  /// Reads the checkpoints in their order, hands each to `visit`, and returns the last one, or none
  /// if there is none. Ends at the first that is missing, or is not what was written, of which
  /// `log_line` is told why; later ones are removed. Throws InputError if they are of another case
  /// text, other meshes or another program, saying which.
  std::optional<Checkpoint> replay(const std::function<void(const CheckpointRecord&)>& visit,
                                   const std::function<void(const std::string&)>& log_line) const;

  /// The run that was interrupted here; none if there is no checkpoint.
  std::optional<KeptRun> kept_run() const;

  /// Removes checkpoint `first` and all later ones, the latest first, then the folder if it is
  /// empty. Files of other names stay.
  void remove_from(long first) const;

 private:
  std::string file(long frame) const;

  std::string folder_;
  RunIdentity identity_;
};

}  // namespace foldproof
