// Frames that another program wrote, or a camera, and their times.
#pragma once

#include <string>
#include <vector>

#include "verification/cases/frame_comparison.h"

namespace foldproof {

/// As typed; the first that is given counts, else what a cache says, else times.txt beside the
/// frames, else what PLY files say.
struct FrameTimes {
  std::string file;            // of times [s], one a line
  double rate = 0, start = 0;  // frames a second, from `start` on [s]; 0: not given
};

/// The frames of a folder or a cache (reference/mesh/mesh_frames.h). Of several sequences the one
/// called `preferred` is read. Throws InputError in one line for what read_mesh_frames refuses,
/// missing times, another number of times than of frames, times that do not ascend, and a gap in
/// the numbers that a rate counts.
std::vector<TimedMesh> read_frames(const std::string& path, const FrameTimes& times,
                                   const std::string& preferred);

}  // namespace foldproof
