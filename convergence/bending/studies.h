// The studies of this room: what does a sheet resist to bending?
#pragma once

#include "convergence/study.h"

namespace foldproof {

// bending-rigidity: by pattern, direction and size of the triangles
Study bending_rigidity_study();
Study cantilever_study();       // cantilever: a clamped strip's tip against the elastica
Study strip_vibration_study();  // strip-vibration: lowest frequencies of a clamped strip
Study shape_return_study();     // shape-recovery: a sculpted shell pulled out of shape and let go
Study buckling_study();         // buckling: critical load and growth of a compressed strip
Study bending_scaling_study();  // bending-scaling: bending damping under refinement

}  // namespace foldproof
