// How deep whole triangles of a cloth lie inside bodies: between their corners, too.
#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "reference/level_set/object.h"
#include "reference/types.h"

namespace foldproof {

/// The corners of a triangle of cloth [m].
using FaceCorners = std::array<Vector3, 3>;

/// The largest depth below the solid's surface of a point of the triangle [m]; not positive if no
/// point is inside. The triangle is in the solid's frame. Closed forms, right to a few roundings of
/// the coordinates.
double deepest_point(const HalfSpace& solid, const FaceCorners& face);
double deepest_point(const Sphere& solid, const FaceCorners& face);
double deepest_point(const Capsule& solid, const FaceCorners& face);
double deepest_point(const Box& solid, const FaceCorners& face);

/// The search for the deepest point where there is no closed form.
struct DepthSearch {
  std::function<double(const Vector3&)> depth;  // below the surface, at a point [m]
  double slope;      // the depth changes by at most this per distance [1]
  double tolerance;  // m
};

/// An upper bound on the depth of every point of the faces [m], at most `tolerance` above the
/// larger of `known` and the true maximum. Faces are split in four until no part can hold a point
/// that is deeper. A search that took 10^6 parts ends: its bound still holds, but may be wider.
double deepest_of(const DepthSearch& search, std::span<const FaceCorners> faces, double known);

/// The largest depth inside one object of a point of the faces at `time` [s], at least `known` [m].
/// Half spaces, spheres, capsules and boxes: closed form. Other bodies: deepest_of their signed
/// distance as built, by which the collisions go; its slope is at most 1 for exact distances
/// (torus, triangles), 2 for grids and octrees, 3 for octrees between two frames of an animation.
double deepest_in_object(const Object& object, double time, std::span<const FaceCorners> faces,
                         double known, double tolerance);

}  // namespace foldproof
