// How far two features of a cloth are from each other, by trying all of their points that
// can be nearest.
#pragma once

#include "verification/oracles/estimate.h"
#include "verification/oracles/exact_crossing_times.h"

namespace foldproof::oracles {

/// The least distance between the closed features [m], in 50 digits: between corners, from corners
/// to feet within edges and within the triangle, between feet within both edges. Degenerate ones
/// have fewer feet.
Estimate feature_distance(Features features, const FourPoints& x);

}  // namespace foldproof::oracles
