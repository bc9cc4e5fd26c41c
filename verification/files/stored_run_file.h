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

/// Only the motion of the cloth of a stored simulation: the minimum that any program can write.
struct StoredFrames {
  std::vector<Triangle> triangles;  // /mesh/triangles, M
  std::vector<double> times;        // /frames/time, T [s]
  std::vector<double> positions;    // /frames/positions, T x N x 3 [m]

  PerParticle3 frame(std::size_t k) const;  // 3 x N [m]
};

/// Throws InputError naming the file if it lacks one of these, or they do not fit together.
StoredFrames read_stored_frames(const std::string& path);

/// Reads a stored simulation; meshes that its case names by a relative path are looked for beside
/// the case file that was simulated, those of --set from the working folder. Throws InputError
/// naming the file if it holds no simulation, or if its cloth does not match its case text.
StoredRun read_stored_run(const std::string& path);

}  // namespace foldproof
