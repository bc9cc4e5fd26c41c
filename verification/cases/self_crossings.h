// Does the cloth pass through itself?
#pragma once

#include "reference/scene/scene.h"
#include "verification/cases/quantities.h"

namespace foldproof {

/// Pairs of an edge and a triangle of the cloth that meet, decided without rounding: see
/// verification/oracles/exact_crossings.h for what is counted. NaN if a position is not finite.
double self_crossings(const Scene& scene, const State& frame);
double self_crossings_at_end(const RunView& run);

}  // namespace foldproof
