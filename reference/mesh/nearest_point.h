// The nearest point of a triangle to a given point, and the feature that it lies on.
#pragma once

#include <array>
#include <limits>

#include "reference/types.h"

namespace foldproof {

/// Vertices, edges and face of a triangle (a, b, c); edges are named by their ends.
enum class Feature { a, b, c, ab, bc, ca, face };

/// The point of a mesh that is nearest to another point.
struct NearestFeature {
  int triangle = -1;                // place in the order of the tree; -1: none within the bound
  Feature feature = Feature::face;  // of that triangle
  Vector3 point = Vector3::Zero();  // m
  double squared_distance = std::numeric_limits<double>::infinity();  // m^2
};

using Corners3 = std::array<Vector3, 3>;  // a, b, c of a triangle [m]

/// The point of the triangle nearest to p and the feature that it lies
/// on; `triangle` is left at -1.
NearestFeature nearest_on_triangle(const Corners3& corners, const Vector3& p);

}  // namespace foldproof
