// The points of the cloth that are kept out of objects: its particles and, for coarse cloth, also
// edge midpoints and triangle centres.
#pragma once

#include <array>
#include <limits>
#include <span>
#include <vector>

#include "reference/level_set/object.h"
#include "reference/mesh/triangle_mesh.h"
#include "reference/types.h"

namespace foldproof {

/// A point that is the mean of one, two or three particles. share_i is the velocity change of
/// particle i per velocity change of the point, from the least impulses that achieve it:
///   share_i = m_i^{-1} / sum_j weight_j m_j^{-1}    (equal weights),
/// so sum_i weight_i share_i = 1.
struct CollisionPoint {
  std::array<int, 3> particles{-1, -1, -1};  // -1: none
  int count = 0;
  Vector3 shares = Vector3::Zero();  // 1
  // Coulomb's coefficient of the cloth there, in place of the objects'; NaN: theirs [1]
  double friction = std::numeric_limits<double>::quiet_NaN();

  /// Mean of its particles' columns.
  Vector3 mean(const PerParticle3& of) const {
    Vector3 sum = of.col(particles[0]);
    for (int k = 1; k < count; ++k) sum += of.col(particles[size_t(k)]);
    return count == 1 ? sum : Vector3(sum / count);
  }
};

/// Particles only; particles and edge midpoints; or these and triangle centres.
enum class PointKind { particles, edges, faces };

/// Points without a free particle are left out. Centres come first and particles last, so that the
/// correction of a particle is final. inverse_mass: N [1/kg], 0 for prescribed particles.
std::vector<CollisionPoint> collision_points(const TriangleMesh& mesh,
                                             const PerParticle& inverse_mass, PointKind kind);

/// Each object's answer at p, a place of the point, with the point's own friction if it has one.
template <class Objects>
std::span<ObjectPoint> answers_at(Objects& objects, const CollisionPoint& point, const Vector3& p) {
  const std::span<ObjectPoint> answers = objects.at(p);
  if (point.friction >= 0)
    for (ObjectPoint& answer : answers) answer.friction = point.friction;
  return answers;
}

}  // namespace foldproof
