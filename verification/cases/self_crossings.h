// Self-intersections of the cloth.
#pragma once

#include "reference/scene/scene.h"
#include "verification/cases/quantities.h"

namespace foldproof {

/// Pairs of an edge and a triangle of the cloth that intersect, in exact arithmetic;
/// verification/oracles/exact_crossings.h defines which pairs count. NaN if a
/// position is not finite.
double self_crossings(const Scene& scene, const State& frame);
double self_crossings_at_end(const RunView& run);

}  // namespace foldproof
