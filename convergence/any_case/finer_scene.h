// The same scene with less discretisation error: what it changes is the scene's own error.
#pragma once

#include "reference/scene/scene.h"

namespace foldproof {

/// The scene with every limit on its step halved.
Scene with_half_steps(const Scene& scene);

/// The scene with each triangle of its cloth divided into four by the middles of its edges: the
/// same surfaces at rest and at the start, the same material, the same rest angles along the old
/// edges and none across the new ones. Particles keep their numbers; the middle of an edge is held
/// where both of its ends are held by the same motion, and may stick where both may. A thickness
/// for self-collision that is too much for triangles half as high becomes what they allow: it, too,
/// is a length of the mesh.
Scene with_finer_mesh(const Scene& scene);

}  // namespace foldproof
