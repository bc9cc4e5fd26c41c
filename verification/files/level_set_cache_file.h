// Level sets of a whole animation in a file, computed once for many runs (BMF03 section 5.1).
#pragma once

#include <string>

#include "reference/level_set/deforming.h"

namespace foldproof {

/// Writes the frames with the key of their input, under a temporary name until complete.
void write_level_sets(const std::string& path, const DeformingBody& body,
                      const std::string& origin);

/// Reads them. Throws std::runtime_error with the reason: missing, not HDF5 or incomplete, not a
/// level-set file, stale (input differs from `origin`), changed since it was written, or invalid.
DeformingBody read_level_sets(const std::string& path, const std::string& origin,
                              const OctreeSettings& settings, BetweenFrames between);

}  // namespace foldproof
