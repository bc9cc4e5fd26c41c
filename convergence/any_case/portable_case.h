// A case in the words of the protocol, so that another solver can run it.
#pragma once

#include "reference/scene/scene.h"
#include "verification/subjects/pipe/portable_scene.h"

namespace foldproof {

/// The scene as physical constants: Young's modulus, bending rigidity B = ke/4, dampings, held
/// particles, fixed planes, boxes, spheres and capsules, thickness. `dt` is left to the caller.
/// The reference's own method (bending law, weighting, time integrator) stays out. Throws
/// InputError naming a part that the protocol cannot say: particles or objects that move, objects
/// of other shapes, strain limits, sticking.
PortableScene portable_case(const Scene& scene);

}  // namespace foldproof
