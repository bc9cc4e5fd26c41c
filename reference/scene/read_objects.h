// The objects of a case: [[object]] and [collision].
#pragma once

#include <string>

#include "reference/scene/key_file.h"
#include "reference/scene/scene.h"

namespace foldproof {

/// Reads both into the scene. folder: where relative files of the case are looked for.
void read_objects(const KeyTable& keys, const std::string& folder, Scene& scene);

}  // namespace foldproof
