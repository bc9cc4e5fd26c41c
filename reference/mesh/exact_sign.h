// Exact signs of determinants of coordinates: the side of a plane or line on which a point lies, or
// whether it lies on it.
#pragma once

#include <Eigen/Core>

#include "reference/types.h"

namespace foldproof {

/// The sign of (b - a) x (c - a) . (d - a): positive when d lies on the side from which the
/// triangle a, b, c appears counter-clockwise; 0 when all four lie in a plane. Exact as long as no
/// product of three differences of coordinates overflows or falls below 1e-290. It is computed in
/// double first; where the error bound leaves the sign open, again in sums of doubles without
/// rounding (Shewchuk 1997).
int side_of_plane(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d);

/// The sign of the area of a, b, c in the plane: positive when counter-clockwise; as
/// exact as above.
int side_of_line(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c);

}  // namespace foldproof
