// The usual test for crossings of moving features, to compare with: roots of a cubic, and a
// tolerance for rounding (Bridson, Fedkiw and Anderson 2002).
#pragma once

#include "reference/filters/feature_pair.h"

namespace foldproof {

/// Do the four points meet while they move straight from x to x + displacement (3 x 4 [m])? At each
/// real root in [0, 1] of the coplanarity cubic, and at the end, the features are tested for a
/// distance below `tolerance` [m]. A motion within one plane has no cubic; it is tested at its end
/// only.
bool cubic_crossing(PairKind kind, const Corners4& x, const Corners4& displacement,
                    double tolerance);

}  // namespace foldproof
