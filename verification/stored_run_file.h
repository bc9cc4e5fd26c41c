// A simulation read back from the HDF5 file that TrajectoryFile wrote.
#pragma once

#include <string>
#include <vector>

#include "reference/scene/scene.h"

namespace foldproof {

struct StoredRun {
  Scene scene;                                // read anew from the case text in the file
  std::vector<double> times;                  // T [s]
  std::vector<double> positions, velocities;  // T x N x 3 [m], [m/s]

  State frame(std::size_t k) const;
};

/// Reads a stored simulation; meshes that its case names by a relative path are looked for beside the case file
/// that was simulated, those of --set from the working folder. Throws InputError naming the file if it holds no
/// simulation, or one of another cloth than its case text says.
StoredRun read_stored_run(const std::string& path, const LevelSetMakers& makers);

}  // namespace foldproof
