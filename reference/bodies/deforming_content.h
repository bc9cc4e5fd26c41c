// What a deforming body is made of and made into, as keys: equal keys, equal content. For caches.
#pragma once

#include <string>

#include "reference/level_set/deforming.h"

namespace foldproof {

/// 16 hexadecimal digits of everything that the level sets are computed from: triangles, times,
/// positions and settings, bit for bit, and the version of the method. Two contents share a key
/// with probability 2^-64.
std::string input_key(const MeshSequence& sequence, const OctreeSettings& settings);

/// The same of the level sets themselves: it tells whether stored ones are as they were written.
std::string content_key(const DeformingBody& body);

/// Throws InputError saying what is wrong with a body that no build made: frames that do not rise,
/// indices out of range, arrays of lengths that do not fit, values that are no numbers. A sound
/// body can be asked anywhere.
void require_valid_content(const DeformingBody& body);

}  // namespace foldproof
