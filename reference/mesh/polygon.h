// Polygons of files, cut into triangles.
#pragma once

#include <span>
#include <vector>

#include "reference/mesh/triangle_mesh.h"

namespace foldproof {

/// A polygon that is not convex has at most so many corners: the work grows as their cube.
constexpr int most_concave_corners = 1000;

/// The triangles of a polygon (at least three corners, columns of x, 3 x N [m]), oriented as it is.
/// Seen along its area vector, half the sum of the cross products of successive corners: a polygon
/// that its first corner sees whole within a half-plane, as it does where all are convex, is the
/// fan about that corner, or a convex one of more than most_concave_corners is cut by halves; every
/// other one is cut so that its worst triangle, by area over longest side squared, is as good as
/// can be. A corner repeated at once counts once. A polygon that is not
/// flat is so cut as its shadow is, and the triangles bend with the corners. One in a line is
/// the fan of its corners as they stand. Empty: its sides cross, or it is concave with too many
/// corners.
std::vector<Triangle> triangles_of_polygon(std::span<const int> corners, const PerParticle3& x);

}  // namespace foldproof
