// Level sets of a whole animation in a file, computed once for many runs (BMF03 section 5.1).
#pragma once

#include <string>

#include "reference/level_set/deforming.h"

namespace foldproof {

/// Writes the frames with the key of what they were computed from, under a temporary name until
/// they are whole.
void write_level_sets(const std::string& path, const DeformingBody& body,
                      const std::string& origin);

/// Reads them. Throws std::runtime_error saying why the file is refused: not there, no HDF5 file or
/// not whole, not a file of level sets, computed from something else than `origin` names (stale),
/// not what was written, unsound.
DeformingBody read_level_sets(const std::string& path, const std::string& origin,
                              const OctreeSettings& settings, BetweenFrames between);

}  // namespace foldproof
