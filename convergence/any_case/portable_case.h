// A case as another solver is given it.
#pragma once

#include "reference/scene/scene.h"
#include "verification/subjects/pipe/portable_scene.h"

namespace foldproof {

/// The scene as physical constants: Young's moduli, bending rigidities B = ke/4 and dampings of its
/// fabrics, membranes, held particles and objects, which may move, layers, strain limits, air.
/// Motions are stated every millisecond and where they start or stop. `dt` is left to the caller.
/// The reference's own method (bending law, weighting, time integrator) stays out. Throws
/// InputError naming a part that the protocol cannot say: sticking, a torus, an open mesh,
/// directions of springs, a flat pattern.
PortableScene portable_case(const Scene& scene);

}  // namespace foldproof
