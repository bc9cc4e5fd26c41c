// Small sheets in motion.
#pragma once

#include "reference/scene/scene.h"

namespace foldproof {

/// A free crumpled sheet of irregular triangles with random velocities: stretched and folded, with
/// its own rest angles. Springs and bending, both damped; no gravity. Elastic limit about 6 ms.
Scene free_sheet();

/// The same without any damping.
Scene undamped_sheet();

/// The mesh waved across its plane by `height` [m] and moving; springs and hinges, both damped.
Scene waved_sheet(TriangleMesh mesh, double height);

/// A jittered sheet under gravity, damped, moving: one corner is fixed, two particles are
/// prescribed (an oscillation with drift, a rotation with drift), the others are free. Elastic
/// limit about 2 ms, by the bound.
Scene partly_prescribed_sheet();

}  // namespace foldproof
