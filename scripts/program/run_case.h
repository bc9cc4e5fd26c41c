#pragma once

#include <string>
#include <vector>

#include "reference/bodies/level_set_provider.h"
#include "reference/dynamics/simulate.h"
#include "verification/cases/expectations.h"
#include "verification/files/checkpoint_file.h"
#include "verification/verdict.h"
#include "verification/files/results_file.h"

namespace foldproof {

/// A quantity of [[quantity]], or one of the usual ones of a case without any.
struct MeasuredQuantity {
  std::string name;
  double value;  // NaN if the run stopped before its time
  std::string unit;
};

struct CaseRun {
  CaseRecord record;
  std::vector<Record> findings;  // what was expected of it, judged
  RunResult result;
  std::vector<MeasuredQuantity> quantities;
};

/// A case and what is built of it, once: it is described, judged and run by this.
struct BuiltCase {
  Case input_case;
  LevelSetProvider level_sets;  // of its bodies; each is made once
  BuiltScene built;
};

/// level_sets: who makes those of its bodies.
BuiltCase built_case(Case input_case, const LevelSetProvider& level_sets);

/// A line on standard error for each note and warning of the scene.
void log_warnings(const Scene& scene);

/// Simulates the case and writes <folder>/<name>.h5 and .xdmf.
CaseRun run_case(const BuiltCase& of, const std::string& folder, const Provenance& provenance,
                 const Progress& progress);

/// The folder of a run's checkpoints: <folder>/<name>.checkpoints.
std::string checkpoint_path(const Scene& scene, const std::string& folder);
CheckpointFolder checkpoint_folder(const Scene& scene, const std::string& folder);

/// How a run is kept from being lost.
enum class Start {
  fresh,  // checkpoints of an earlier run are removed
  last_checkpoint
};

/// The same, and the same to the bit, with a checkpoint at every frame in
/// <folder>/<name>.checkpoints, which is removed when the run's files are whole.
CaseRun run_case_with_checkpoints(const BuiltCase& of, const std::string& folder, Start start,
                                  const Provenance& provenance, const Progress& progress);

/// The same without files, and without the name of one in the record.
CaseRun run_case_without_files(const BuiltCase& of, const Progress& progress);

/// What is expected, judged; no quantities are measured.
std::vector<Record> judge_case(const BuiltCase& of, const Progress& progress);

/// The cases that `verify` runs, cases/<name>.toml of the project: those that it shows, and those
/// at the edge of what the method takes, which it only judges.
std::vector<std::string> shown_cases(Tier tier);
std::vector<std::string> hard_cases();
std::vector<std::string> long_cases();  // those that only the full tier shows

/// Those of a tier, shown or only judged; the full one has all there are.
std::vector<std::string> built_in_cases(Tier tier);

/// These, and those that `verify` does not run: all that a user can name.
std::vector<std::string> shipped_cases();

/// The file of a shipped case, whose name the lists above have.
std::string shipped_case_file(const std::string& name);

/// Reads cases/<name>.toml of the project, and adds what is expected of every shipped case.
Case built_in_case(const std::string& name);

/// Makers that keep level sets in a folder and say so; those that compute them if it has no name.
/// Both compute on that many threads.
LevelSetProvider provider_for(const std::string& cache, int threads);

}  // namespace foldproof
