// The usual test for crossings of moving features, to compare with: roots of a cubic, and a
// tolerance for rounding (Bridson, Fedkiw and Anderson 2002).
#pragma once

#include "reference/filters/feature_pair.h"

namespace foldproof {

/// Do the four points, which move straight from x to x + displacement (3 x 4 [m]), meet? At each
/// real root in [0, 1] of the cubic for which they are in one plane, and at the end, the features
/// are asked whether they are nearer than `tolerance` [m]. A motion in one plane throughout has no
/// cubic, and is asked at its end alone.
bool cubic_crossing(PairKind kind, const Corners4& x, const Corners4& displacement,
                    double tolerance);

}  // namespace foldproof
