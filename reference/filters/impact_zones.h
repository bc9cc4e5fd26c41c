// Rigid impact zones: particles whose collisions impulses do not resolve move together (Provot
// 1997; Bridson, Fedkiw, Anderson 2002, section 7.5).
#pragma once

#include <vector>

#include "reference/filters/feature_pair.h"
#include "reference/types.h"

namespace foldproof {

/// Which particles move together. Zones grow and merge; they never part.
class ImpactZones {
 public:
  explicit ImpactZones(Eigen::Index particles);

  /// Puts the pair's particles, and the zones they are in, into one zone.
  void join(const FeaturePair& pair);

  bool are_joined(const FeaturePair& pair) const;  // all four in one zone

  /// The zones that have grown since the last call, each with its particles in ascending order.
  std::vector<std::vector<int>> take_grown_zones();

  long zones() const;      // of two particles or more
  long particles() const;  // in them

 private:
  int root_of(int particle) const;

  std::vector<int> parent_;  // N: a root is its own
  std::vector<int> size_;    // N: of a root's zone
  std::vector<char> grown_;  // N: of roots
};

/// Gives the zone's particles the velocities of a rigid motion, u + omega x (x - c), the one that
/// keeps their linear and angular momentum: to rounding, of free ones. Prescribed particles keep
/// theirs, and lead the zone where there are any. Along x + t v no two points of the zone meet,
/// for any t, since the map 1 + t [omega]x has no kernel. x, v: 3 x N [m], [m/s]. Returns how far
/// the motion misses the velocities of its prescribed particles [m/s]: rounding, unless these do
/// not move as one.
double move_as_one(const std::vector<int>& zone, const PerParticle3& x, const PerParticle& mass,
                   const PerParticle& inverse_mass, PerParticle3& v);

}  // namespace foldproof
