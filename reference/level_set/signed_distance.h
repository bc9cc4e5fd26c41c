// Signed distance to solids, and the solids with a closed form for it. Each has its own frame;
// objects place and move them.
#pragma once

#include <concepts>

#include "reference/types.h"

namespace foldproof {

/// Answer of a solid at a point.
struct Distance {
  double phi;  // signed distance to its surface, negative inside [m]
  // N = grad phi, outward, a unit vector; at a kink of phi, the normal of one side
  Vector3 normal;
};

/// A solid is anything that returns its signed distance.
template <class S>
concept SignedDistance = requires(const S solid, Vector3 p) {
  { solid.at(p) } -> std::same_as<Distance>;
};

/// The half space z < 0.
struct HalfSpace {
  Distance at(const Vector3& p) const;
};

/// About the origin.
struct Sphere {
  double radius;  // m
  Distance at(const Vector3& p) const;
};

/// About the origin, its edges along the axes.
struct Box {
  Vector3 half_extents;  // m
  Distance at(const Vector3& p) const;
};

/// All points within `radius` of the segment of the z axis from -half_length to half_length.
struct Capsule {
  double radius, half_length;  // m
  Distance at(const Vector3& p) const;
};

/// All points within `tube_radius` of the circle of radius `ring_radius` in the xy plane.
struct Torus {
  double ring_radius, tube_radius;  // m
  Distance at(const Vector3& p) const;
};

}  // namespace foldproof
