// Sticky patches and the particles that stick to them: [[sticky]].
#pragma once

#include <string>

#include "reference/scene/key_file.h"
#include "reference/scene/scene.h"

namespace foldproof {

/// Reads [[sticky]] into the scene; needs its cloth, schedule and objects.
///   case_keys   of the whole file; [cloth] and [[object]] name the OBJ files with the groups
///   folder      base of relative paths in the case
void read_sticky(const KeyTable& case_keys, const std::string& folder, Scene& scene);

}  // namespace foldproof
