// A folder of frames that another program wrote, or a camera: which files they are, and when.
#pragma once

#include <string>
#include <vector>

#include "verification/cases/frame_comparison.h"

namespace foldproof {

/// As typed; the first that is given counts, else times.txt in the folder, else what PLY files say.
struct FrameTimes {
  std::string file;            // of times [s], one a line
  double rate = 0, start = 0;  // frames a second, from `start` on [s]; 0: not given
};

/// The frames in FOLDER/NAME*.obj or .ply, in the order of the numbers that their names end
/// with. Of several sequences the one called `preferred` is read. Throws InputError in one line
/// for a folder without frames, several sequences, missing times, as many times as there are no
/// frames, times that do not ascend, a gap in the numbers that a rate counts, and a frame that
/// cannot be read.
std::vector<TimedMesh> read_frames(const std::string& folder, const FrameTimes& times,
                                   const std::string& preferred);

}  // namespace foldproof
