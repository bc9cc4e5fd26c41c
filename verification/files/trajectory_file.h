// A simulation in an HDF5 file, for the report, for numpy and for ParaView.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "reference/dynamics/simulate.h"
#include "reference/scene/scene.h"
#include "verification/verdict.h"
#include "verification/files/provenance_file.h"

namespace foldproof {

/// Writes a simulation while it runs: to "<path>.partial", renamed to `path` by finish(), with an
/// XDMF file beside it that ParaView opens. What was written before a stop or an interruption is
/// kept in the partial file.
class TrajectoryFile {
 public:
  /// scene, and its objects as built: must outlive the file.
  TrajectoryFile(const std::string& path, const Scene& scene, const System& system,
                 std::span<const Object> objects, const Provenance& provenance);
  ~TrajectoryFile();
  TrajectoryFile(const TrajectoryFile&) = delete;
  TrajectoryFile& operator=(const TrajectoryFile&) = delete;

  void add_frame(const State& s);
  void add_diagnostics(const Diagnostics& row);

  /// stopped: "" or why the run ended early. findings: its judged expectations.
  void finish(const std::string& stopped, double seconds, const std::vector<Record>& findings);

 private:
  struct Content;
  std::unique_ptr<Content> content_;
};

}  // namespace foldproof
