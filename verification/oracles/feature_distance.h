// Distance of two features of a cloth, by trying all candidate nearest points.
#pragma once

#include "verification/oracles/estimate.h"
#include "verification/oracles/exact_crossing_times.h"

namespace foldproof::oracles {

/// The least distance between the closed features [m], in 50 digits: between corners, from corners
/// to feet within edges and within the triangle, between feet within both edges. Degenerate
/// features have fewer feet.
Estimate feature_distance(Features features, const FourPoints& x);

}  // namespace foldproof::oracles
