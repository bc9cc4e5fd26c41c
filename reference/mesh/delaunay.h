// Delaunay triangulation of points in the plane.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "reference/mesh/triangle_mesh.h"

namespace foldproof {

/// The Delaunay triangulation of the points (2 x N [m]): triangles counter-clockwise, each starting
/// at its smallest index, sorted.
///
/// Accuracy: exact for the points rounded to a grid of 2^-30 of their extent. Where four or
/// more points lie on a circle, one of the valid choices is taken. Triangles at most two units
/// of that grid high are left out: they arise only along the border, where points lie on a line to
/// rounding.
/// Throws InputError: fewer than three points, a coordinate not finite, points that coincide on the
/// grid, all on a line.
std::vector<Triangle> delaunay(const Eigen::Matrix2Xd& points);

}  // namespace foldproof
