// A disc cut into flat sectors, and the cone that it forms when it hangs from its centre.
#pragma once

#include <array>
#include <vector>

#include "reference/types.h"

namespace foldproof::oracles {

/// Straight spokes divide the disc into equal sectors. Up to `core` of its radius each sector is
/// one triangle; beyond, rings are as far apart as spokes. A cone over a polygon folds at the
/// spokes alone and stretches nothing. Particle 0 is the centre; the particles of a ring are
/// consecutive, from the innermost ring out. The mesh is symmetric about two diameters, so that two
/// folds stay still on it.
struct DiscOfSectors {
  int sectors;    // a multiple of 4
  double radius;  // m
  double core;    // of the radius [1]

  int rings() const;                                  // beyond the core's own
  int particle(int ring, int spoke) const;            // ring 0 is the core's
  PerParticle3 rest() const;                          // in the plane z = 0 [m]
  std::vector<std::array<int, 3>> triangles() const;  // normals +z
};

/// Directions of the spokes on the unit sphere, neighbours apart by the angle of a sector. They
/// form a polygon whose vertices have the heights of the hung cone of this weight, except for a
/// shift that closes it.
std::vector<Vector3> spokes_of_hung_cone(int folds, double weight, int sectors);

}  // namespace foldproof::oracles
