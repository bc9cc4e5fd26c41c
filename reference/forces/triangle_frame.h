// A place in the frame of a moving triangle (weights of the corners and a height above it), and its
// motion with the corners. To average B places, weights sum to 1/B and heights are divided by B.
#pragma once

#include <array>
#include <vector>

#include "reference/mesh/nearest_point.h"
#include "reference/types.h"

namespace foldproof {

//      c           N = (b - a) x (c - a), n = N/|N|
//     / \          place = w_a a + w_b b + w_c c + height n
//    / .-\--- foot
//   a --- b        g_a = n x (c - b)/|N|: the in-plane gradient of w_a; cyclic
//
// However the corners move, n stays normal to the edges, so dn = - sum_i g_i (n . dx_i), and
//   d place = sum_i (w_i - height g_i n^T) dx_i
struct TriangleFrame {
  std::array<int, 3> corners;  // particles, or columns of a surface's corner positions
  Vector3 weights;             // 1
  double height;               // m
  Vector3 normal;              // n
  Eigen::Matrix3d slopes;      // columns g_a, g_b, g_c [1/m]
};

/// The place of p as stored in a bond: weights of the corners b and c, height [m]. NaN if the
/// triangle has no area.
Vector3 local_place(const Corners3& corners, const Vector3& p);

/// The frame of a triangle with that place, scaled by `part`: 1/B for one of B places. The triangle
/// must have nonzero area.
TriangleFrame frame_of(const std::array<int, 3>& particles, const PerParticle3& x,
                       const Vector3& place, double part);

/// The sum of the frames' places at the corner positions x for which they were made (3 x N [m]).
Vector3 place_of(const std::vector<TriangleFrame>& frames, const PerParticle3& x);

/// J v: the velocity of that place [m/s] for corner velocities v (3 x N [m/s]).
Vector3 frame_velocity(const std::vector<TriangleFrame>& frames, const PerParticle3& v);

/// f += J^T force: distributes a force [N] at the place over the corners. The sum is the force.
void add_corner_forces(const std::vector<TriangleFrame>& frames, const Vector3& force,
                       PerParticle3& f);

/// f += (dJ)^T force, with dJ the change of J for corner displacements dx (3 x N [m]). With g_i and
/// n as above, and
///   d(g_i) = - sum_j g_j (g_i . dx_j) + n sum_j (g_i . g_j) (n . dx_j)
void add_corner_force_change(const std::vector<TriangleFrame>& frames, const Vector3& force,
                             const PerParticle3& dx, PerParticle3& f);

/// (dJ) v [m/s]: the same change of J, applied to velocities v.
Vector3 frame_velocity_change(const std::vector<TriangleFrame>& frames, const PerParticle3& dx,
                              const PerParticle3& v);

}  // namespace foldproof
