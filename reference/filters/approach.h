// Continuous collision detection of two moving features of the cloth by conservative advancement.
#pragma once

#include <optional>

#include "reference/filters/feature_pair.h"
#include "reference/types.h"

namespace foldproof {

struct Approach {
  double time;  // fraction of the motion, 0 to 1
  Nearness at;  // at that time
};

/// The four points move straight from x to x + displacement (3 x 4 [m]). Features that start
/// farther apart than `min_distance` [m] must stay so; features that start nearer must keep half of
/// their distance.
///   nothing   they stay farther apart than that, during the whole motion
///   a time    at which they are within 1.5 times that distance, or have used half of the
///             distance that they may lose, or from which 1000 separating planes did not suffice
///             to prove their motion harmless
/// A collision is never missed, even if the motion is coplanar throughout or grazing, as long
/// as the distance to keep exceeds the rounding of the coordinates; a near miss may be
/// reported. Steps without a report can be repeated indefinitely: distances may approach
/// `min_distance` but never fall below it.
std::optional<Approach> first_approach(PairKind kind, const Corners4& x,
                                       const Corners4& displacement, double min_distance);

}  // namespace foldproof
