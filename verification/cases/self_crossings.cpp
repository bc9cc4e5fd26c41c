#include "verification/cases/self_crossings.h"

#include <limits>

#include "verification/oracles/exact_crossings.h"

namespace foldproof {

double self_crossings(const Scene& scene, const State& frame) {
  if (!frame.x.allFinite()) return std::numeric_limits<double>::quiet_NaN();
  return double(oracles::exact_crossings(frame.x, scene.mesh.triangles).size());
}

double self_crossings_at_end(const RunView& run) {
  return self_crossings(run.scene, run.result.last);
}

}  // namespace foldproof
