// Rigid impact zones: particles whose collisions cannot be resolved by impulses move together
// (Provot 1997; Bridson, Fedkiw, Anderson 2002, section 7.5).
#pragma once

#include <vector>

#include "reference/filters/feature_pair.h"
#include "reference/types.h"

namespace foldproof {

/// Sets of particles that move together. Zones grow and merge; they never split.
class ImpactZones {
 public:
  explicit ImpactZones(Eigen::Index particles);

  /// Puts the pair's particles, and the zones they are in, into one zone.
  void join(const FeaturePair& pair);

  bool are_joined(const FeaturePair& pair) const;  // true if all four are in one zone

  /// The zones that have grown since the last call, each with its particles in ascending order.
  std::vector<std::vector<int>> take_grown_zones();

  long zones() const;      // number of zones with two or more particles
  long particles() const;  // number of particles in zones

 private:
  int root_of(int particle) const;

  std::vector<int> parent_;  // N: a root is its own parent
  std::vector<int> size_;    // N: of a root's zone
  std::vector<char> grown_;  // N: of roots
};

/// Gives the zone's particles the velocities of a rigid motion, u + omega x (x - c). For free
/// particles it conserves linear and angular momentum to rounding. Prescribed particles keep
/// their velocities and, if there are any, drive the zone. No two points of the zone meet along
/// x + t v, for any t, because the map 1 + t [omega]x has no kernel. x, v: 3 x N [m], [m/s].
/// Returns the deviation of the motion from its prescribed velocities [m/s]: rounding, unless
/// these are not a rigid motion.
double move_as_one(const std::vector<int>& zone, const PerParticle3& x, const PerParticle& mass,
                   const PerParticle& inverse_mass, PerParticle3& v);

}  // namespace foldproof
