// The objects of a case: [[object]] and [collision].
#pragma once

#include "reference/scene/key_file.h"
#include "reference/scene/read_bodies.h"
#include "reference/scene/scene.h"

namespace foldproof {

/// Reads both into the scene; needs its schedule.
void read_objects(const KeyTable& keys, const CaseContext& context, Scene& scene);

}  // namespace foldproof
