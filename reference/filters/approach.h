// Do two features of the cloth come together while they move? Continuous collision detection by
// conservative advancement.
#pragma once

#include <optional>

#include "reference/filters/feature_pair.h"
#include "reference/types.h"

namespace foldproof {

struct Approach {
  double time;  // share of the motion, 0 to 1
  Nearness at;  // then
};

/// The four points move from x straight to x + way (3 x 4 [m]). Two features that start farther
/// apart than `min_distance` [m] are to stay so; of those that start nearer, half of their
/// distance is to be kept.
///   nothing   they stay farther apart than that, during the whole motion
///   a time    at which they are within half as much again of it, or have lost half of what they
///             had to lose, or from which on 1000 planes did not suffice to show their motion
///             harmless
/// A meeting is never missed, whatever the motion, coplanar all along or grazing, as long as what
/// is to be kept is beyond the rounding of the coordinates; what comes near without meeting may be
/// reported. A step after which nothing was reported can be followed by another for ever: distances
/// may tend to `min_distance`, and do not fall below it.
std::optional<Approach> first_approach(PairKind kind, const Corners4& x,
                                       const Corners4& displacement, double min_distance);

}  // namespace foldproof
