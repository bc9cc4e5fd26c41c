// Sample octrees, and their discontinuities.
#pragma once

#include "reference/level_set/octree.h"

namespace foldproof {

/// Points of a cube about the origin, uniform at random.
std::vector<Vector3> random_points(int count, double half_width, unsigned seed);

/// A torus of radii 0.29 m and 0.11 m, rotated and shifted out of alignment with the axes.
Distance tilted_torus(const Vector3& p);

/// A cube of 1 m about the origin, sampled to `tolerance` [m] in a band of 0.06 m, with cells down
/// to 1/2^depth m.
OctreeSettings sampling(int depth, double tolerance, HangingNodes hanging);

/// The largest jump [m] of phi over `count` random points where two cells meet, one of them in a
/// branch at level `deepest` or above.
double largest_jump(const Octree& tree, int count, int deepest = 99);

}  // namespace foldproof
