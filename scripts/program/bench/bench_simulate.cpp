// What a step costs whoever types `simulate`: automatic, observed, judged, frames and
// checkpoints written.
#include <filesystem>

#include "scripts/program/bench/bench_parts.h"
#include "scripts/program/provenance.h"
#include "scripts/program/run_case.h"

namespace foldproof {

double seconds_per_simulated_step(const Scene& scene, double step) {
  const int steps_per_frame = 15, frames = 2;
  BuiltCase of = built_case({scene, {}}, computing_provider());
  of.input_case.scene.name = "bench";
  of.input_case.scene.schedule.frame_interval = steps_per_frame * step;
  of.input_case.scene.schedule.end = frames * steps_per_frame * step;
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("foldproof-bench-" + program_digest());
  std::filesystem::create_directories(folder);
  const Provenance by = provenance("bench");
  long steps = 0;
  const double seconds = least_seconds([&] {
    steps = run_case_with_checkpoints(of, folder.string(), Start::fresh, by, [](double) {
            }).result.steps;
  });
  std::filesystem::remove_all(folder);
  return seconds / double(steps);
}

}  // namespace foldproof
