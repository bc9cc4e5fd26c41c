// Cache keys of a deforming body: of its input, and of the level sets built from it.
#pragma once

#include <string>

#include "reference/level_set/deforming.h"

namespace foldproof {

/// 16 hexadecimal digits that identify all input of the level sets: triangles, times, positions and
/// settings, bit for bit, and the version of the method. Two different inputs collide with
/// probability 2^-64.
std::string input_key(const MeshSequence& sequence, const OctreeSettings& settings);

/// The key of the level sets themselves; it detects stored data that has changed since it was
/// written.
std::string content_key(const DeformingBody& body);

/// Validates a body that was read rather than built. Throws InputError naming the defect: frame
/// times that do not increase, indices out of range, arrays of mismatched length, values that are
/// not finite. A valid body can be queried anywhere.
void require_valid_content(const DeformingBody& body);

}  // namespace foldproof
