// The table [start] of a case: changes to the cloth before time 0.
#pragma once

#include "reference/scene/key_file.h"
#include "reference/scene/scene.h"

namespace foldproof {

/// Changes the scene's start, x and v; the rest shape stays. Throws InputError "file:line: ...".
void read_start(const KeyTable& keys, Scene& scene);

}  // namespace foldproof
