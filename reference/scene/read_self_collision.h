// The table [self_collision] of a case.
#pragma once

#include "reference/filters/repulsion.h"
#include "reference/scene/key_file.h"
#include "reference/scene/scene.h"

namespace foldproof {

/// The thickness is the largest of the scene's fabrics. Throws InputError "file:line: ..." for
/// values out of range, and for a thickness of half the least height of a triangle or more:
/// neighbours would repel each other at rest.
SelfCollisionSettings read_self_collision(const KeyTable& keys, const Scene& scene);

/// Throws InputError for a start at which layers are nearer than a few roundings of their places,
/// so that no motion is safe. If some cross exactly, which is reported, it is a warning at most.
void reject_touching_start(const KeyTable& keys, Scene& scene);

/// With untangle = false, throws InputError naming the first triangles of a start that
/// crosses itself.
void reject_tangled_start(const KeyTable& keys, const Scene& scene);

}  // namespace foldproof
