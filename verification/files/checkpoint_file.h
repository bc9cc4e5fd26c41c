// Checkpoints of a simulation: a folder of small HDF5 files, one per frame, from which an
// interrupted run resumes.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "reference/dynamics/simulate.h"
#include "reference/scene/scene.h"

namespace foldproof {

/// Everything that a run's results depend on. Checkpoints of different runs are never mixed.
struct RunIdentity {
  std::string case_text;  // with its overrides
  std::string meshes;     // key of all files read besides the case file
  std::string program;    // its version, and a key of its code
};

RunIdentity identity_of(const Scene& scene, const std::string& program);

/// Data added since the previous checkpoint: the frame, which is the latest state of `at`, and the
/// rows since then.
struct CheckpointRecord {
  Checkpoint at;
  std::vector<Diagnostics> rows;
};

/// Progress of the run whose checkpoints are in a folder.
struct KeptRun {
  long frame = -1;  // of the last complete checkpoint; -1: none
  double time = 0;  // of that frame [s]
  // how the stored run differs from the requested one; "" if it can be resumed
  std::string differs;
};

/// Files 000000.h5, 000001.h5, ... in a folder of their own, each renamed when complete. Each holds
/// only the data since the previous one, so the total size is proportional to the number of frames;
/// they are usable up to the first gap.
class CheckpointFolder {
 public:
  /// Creates nothing yet.
  CheckpointFolder(std::string folder, RunIdentity identity);

  /// Creates the folder if needed. Throws std::runtime_error naming the file.
  void write(const CheckpointRecord& record) const;

  /// Reads the checkpoints in their order, hands each to `visit`, and returns the last one, if any.
  /// Stops at the first that is missing or corrupt, passes the reason to `log_line`, and removes
  /// the later ones. Throws InputError if they belong to another case text, other meshes or another
  /// program, naming which.
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
