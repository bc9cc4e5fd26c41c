#pragma once

#include <string>
#include <vector>

#include "reference/dynamics/simulate.h"
#include "reference/scene/scene.h"
#include "verification/results_file.h"

namespace foldproof {

struct CaseRun {
  CaseRecord record;
  std::vector<Record> findings;  // that it reached its end, and that its energy is accounted for
  Outcome outcome;
};

/// Simulates the scene with progress shown and writes <folder>/<name>.h5 and .xdmf.
CaseRun run_case(const Scene& scene, const std::string& folder, const Provenance& provenance);

/// The cases that `verify` runs: cases/<name>.toml of the project.
std::vector<std::string> built_in_cases();

}  // namespace foldproof
