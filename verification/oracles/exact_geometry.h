// Inside and intersection tests without rounding: the given doubles are exact numbers, and every
// decision is the sign of a polynomial in rational arithmetic.
#pragma once

#include <array>
#include <vector>

#include "reference/types.h"

namespace foldproof::oracles {

using Corners3 = std::array<Vector3, 3>;  // of a triangle [m]

/// A closed, oriented surface of triangles, or a sheet.
struct TriangleSoup {
  PerParticle3 x;                             // 3 x N [m]
  std::vector<std::array<int, 3>> triangles;  // M
};

Corners3 corners(const TriangleSoup& soup, std::size_t triangle);

/// The surface of an axis-aligned box, two triangles a side, whose corners have exactly these
/// coordinates [m].
TriangleSoup box_between(const Vector3& low, const Vector3& high);

/// The sign of det(b - a, c - a, d - a): +1, 0 or -1.
int orientation(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d);

/// True if the closed triangles have a point in common.
bool triangles_meet(const Corners3& s, const Corners3& t);

enum class Side { inside, on_surface, outside };

/// For a closed surface, by counting how often a segment to a distant point crosses it; if the
/// segment touches an edge or a corner, another one is tried. Orientation does not matter. Throws
/// std::runtime_error if none of a hundred segments is clean.
Side side_of(const TriangleSoup& surface, const Vector3& p);

/// True if every point of the triangle is farther from `centre` than `radius` [m].
bool clears_ball(const Corners3& t, const Vector3& centre, double radius);

/// Triangles of the cloth that have a point in common with the closed body, surface or interior:
/// they meet a triangle of the surface, or have a corner inside. Ascending.
std::vector<int> triangles_in_body(const TriangleSoup& cloth, const TriangleSoup& body);
std::vector<int> triangles_in_ball(const TriangleSoup& cloth, const Vector3& centre, double radius);

}  // namespace foldproof::oracles
