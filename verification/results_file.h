// Results as HDF5: the runs' findings, studies and cases, and each case's trajectory. The only door to the
// HDF5 library.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "reference/dynamics/simulate.h"
#include "reference/scene/scene.h"
#include "verification/check.h"

namespace foldproof {

/// Where numbers come from: written into every file.
struct Provenance {
  std::string version, commit, tree;  // tree: "clean", "dirty" or "unknown"
  std::string compiler, flags, build_type, cpu, date, command;
  int cores = 0;
};

struct CaseRecord {
  std::string name, file, title, about;  // file: relative to run.h5
  double seconds = 0;
  std::string stopped;  // "" or the reason
};

/// A seeded fault: a textual edit of the reference, and what must notice it.
struct Fault {
  std::string name, file, find, replace, law;
  std::vector<std::string> caught_by;
  std::string outcome;  // "caught", "SURVIVED", ..., or "not run"
};

struct RunRecord {
  Provenance provenance;
  std::string tier, subject, subject_version;
  double seconds = 0;
  std::vector<Record> records;
  std::vector<StudyRecord> studies;
  std::vector<CaseRecord> cases;
  std::vector<Fault> faults;
};

/// Makes sure that the bytes of `from` are on the disk, then gives it the name `to`. Throws
/// std::runtime_error naming the file.
void rename_when_whole(const std::string& from, const std::string& to);

/// Writes the whole run to `path`, under a temporary name first and renamed when complete. Throws
/// std::runtime_error naming the file.
void write_run(const std::string& path, const RunRecord& run);

/// Writes a simulation while it runs: to "<path>.partial", renamed to `path` by finish(), with an XDMF file
/// beside it that
/// ParaView opens. What was written before a stop or an interruption is kept in the partial file.
class TrajectoryFile {
 public:
  TrajectoryFile(const std::string& path, const Scene& scene, const System& system,
                 const Provenance& provenance);
  ~TrajectoryFile();
  TrajectoryFile(const TrajectoryFile&) = delete;
  TrajectoryFile& operator=(const TrajectoryFile&) = delete;

  void add_frame(const State& s);
  void add_diagnostics(const Diagnostics& row);

  /// stopped: "" or why the run ended early.
  void finish(const std::string& stopped, double seconds);

 private:
  struct Content;
  std::unique_ptr<Content> content_;
};

}  // namespace foldproof
