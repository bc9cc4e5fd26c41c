// The sheet that benches step.
#pragma once

#include "reference/scene/scene.h"

namespace foldproof {

/// A square sheet of n x n cells, gently waved and moving, damping ratio 0.1 of springs and hinges
/// at the bound on omega.
struct Load {
  Scene scene;
  System system;
  State state;
  double limit;  // elastic limit [s]
};

Load make_load(int cells);

}  // namespace foldproof
