// Simulates cases with the method alone and writes the bits of their last states: what
// scripts/machines compares between machines. Links nothing but the reference, so that it can be
// built for processors that have none of the other libraries.
//   final_states SECONDS FOLDER CASE.toml...
// writes FOLDER/NAME.state: time, x and v as doubles of this machine. Exit code: 0 all were
// written; 2 bad input.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>

#include "reference/bodies/level_set_provider.h"
#include "reference/dynamics/simulate.h"
#include "reference/scene/scene.h"

namespace {

using namespace foldproof;

/// The first `seconds` of a case.
RunResult run(const std::string& file, double seconds, bool is_nudged) {
  Scene scene = read_scene(file, {});
  scene.schedule.end = std::min(scene.schedule.end, seconds);
  scene.schedule.frame_interval = std::min(scene.schedule.frame_interval, scene.schedule.end);
  BuiltScene built = build(scene, computing_provider());
  if (is_nudged)
    for (double& place : built.start.x.reshaped())
      place = std::nextafter(place, std::numeric_limits<double>::infinity());
  return simulate(built.system, integrator_named(scene.integrator), built.start, scene.schedule,
                  {});
}

void write(const std::string& path, const State& s) {
  std::ofstream file(path, std::ios::binary);
  const auto put = [&](const double* values, Eigen::Index count) {
    file.write(reinterpret_cast<const char*>(values), std::streamsize(count * sizeof(double)));
  };
  put(&s.time, 1);
  put(s.x.data(), s.x.size());
  put(s.v.data(), s.v.size());
  if (!file) throw InputError(path + ": cannot be written");
}

}  // namespace

int main(int count, char** words) {
  if (count < 5) {
    std::fprintf(stderr, "usage: final_states SECONDS NUDGE FOLDER CASE.toml...\n");
    return 2;
  }
  try {
    for (int k = 4; k < count; ++k) {
      const RunResult result = run(words[k], std::atof(words[1]), std::atoi(words[2]) == 1);
      const std::string name = std::filesystem::path(words[k]).stem().string();
      write(std::string(words[3]) + "/" + name + ".state", result.last);
      std::printf("%s %ld\n", name.c_str(), result.steps);
    }
  } catch (const InputError& error) {
    std::fprintf(stderr, "final_states: %s\n", error.what());
    return 2;
  }
  return 0;
}
