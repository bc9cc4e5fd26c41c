// The points of the cloth that are held out of objects: its particles, and, for coarse cloth,
// midpoints of edges and centres of triangles too.
#pragma once

#include <array>
#include <vector>

#include "reference/mesh/triangle_mesh.h"
#include "reference/types.h"

namespace foldproof {

/// A point that is the mean of one, two or three particles, and by how much each of them answers
/// when the point's velocity is to change: by the least impulses that do it,
///   share_i = m_i^{-1} / sum_j weight_j m_j^{-1}    (equal weights),
/// so that sum_i weight_i share_i = 1.
struct CollisionPoint {
  std::array<int, 3> particles{-1, -1, -1};  // -1: none
  int count = 0;
  Vector3 shares = Vector3::Zero();  // 1

  /// Of its particles' columns.
  Vector3 mean(const PerParticle3& of) const {
    Vector3 sum = of.col(particles[0]);
    for (int k = 1; k < count; ++k) sum += of.col(particles[size_t(k)]);
    return count == 1 ? sum : Vector3(sum / count);
  }
};

/// Particles alone, or with midpoints of edges, or with those and centres of triangles.
enum class PointKind { particles, edges, faces };

/// Points that no free particle belongs to are left out. Centres come first and particles last, so
/// that particles have the last word. inverse_mass: N [1/kg], 0 for prescribed particles.
std::vector<CollisionPoint> collision_points(const TriangleMesh& mesh,
                                             const PerParticle& inverse_mass, PointKind kind);

}  // namespace foldproof
