// Decides, without rounding, whether two features of a cloth that move in straight lines ever have
// a point in common.
//
// A vertex p and a triangle f1 f2 f3 have one if and only if the origin is in the triangle f1 - p,
// f2 - p, f3 - p; two edges a0 a1 and b0 b1 when it is in the parallelogram of all differences
// a_i - b_k. Both are flat convex polygons whose corners d_i move in straight lines. With any two
// sides spanning n, the origin is in the polygon if and only if
//   n . d_0 = 0 and n != 0 and every d_i x d_{i+1} points as n does or is zero, or
//   n = 0, which leaves a segment or a point, and some d_i x d_k = 0, d_i . d_k <= 0.
// All these are polynomials of the time, of degree 3 and 2. Closed features share a point during a
// closed set of times. So if they ever do, they do at the start, at the end, or at a root of one of
// these polynomials; unless n . d_0 vanishes identically, at one of its roots.
#pragma once

#include <array>
#include <string>

#include "reference/types.h"
#include "verification/oracles/whole_points.h"

namespace foldproof::oracles {

enum class Features { vertex_and_triangle, edge_and_edge };

// columns: the vertex and the corners; or one edge's ends, the other's
using FourPoints = Eigen::Matrix<double, 3, 4>;

/// Four points at start + t displacement, t in [0, 1], in integer multiples of some unit of length.
struct ExactMotion {
  Quad<Whole> start, displacement;
};

/// The doubles [m] taken as exact numbers.
ExactMotion exact_motion(const FourPoints& start, const FourPoints& displacement);

/// The motion up to the time `end` in [0, 1], slowed down to last from 0 to 1.
ExactMotion until(const ExactMotion& motion, double end);

struct Fraction {
  Whole numerator, denominator;  // the denominator is not zero
};

/// From the first four points to the last four.
ExactMotion motion_between(const std::array<std::array<Fraction, 3>, 8>& points);

/// True if the two closed features, which may be degenerate, have a point in common at some
/// time in [0, 1].
bool ever_meet(Features features, const ExactMotion& motion);

/// True if they have one at rest.
bool meet(Features features, const FourPoints& x);

}  // namespace foldproof::oracles
