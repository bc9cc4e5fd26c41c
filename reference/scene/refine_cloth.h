// A cloth with finer triangles and nothing else changed: [cloth] refine.
#pragma once

#include "reference/scene/key_file.h"
#include "reference/scene/scene.h"

namespace foldproof {

/// Number of times that [cloth] divides triangles into four, 0 to 8; 0 without the key. Throws
/// InputError "file:line: ..." for another number.
int refinements_of(const KeyTable& cloth);

/// Divides each triangle into four at the midpoints of its edges. The rest and start surfaces do
/// not change; nor do velocities, which are linear on each old triangle. Old particles keep their
/// numbers, and those of triangle t are triangles 4t to 4t + 3. Halves of an old edge keep its rest
/// angle; new edges, each within an old triangle, have none. Holds, sticky patches and
/// self-collision are left as they are.
void refine_cloth(Scene& scene);

}  // namespace foldproof
