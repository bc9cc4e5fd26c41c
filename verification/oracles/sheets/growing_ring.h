// A ring of triangles that grow outward: the cloth around the plate of a drape test.
#pragma once

#include <array>
#include <vector>

#include "reference/types.h"

namespace foldproof::oracles {

/// An equilateral lattice, mapped by the exponential: circles of equally many particles, each
/// turned by half a space to the one before. As there are more, every triangle becomes equilateral,
/// its size in proportion to the distance from the axis. The first circle is half a row of
/// triangles inside the plate's rim and the second one half a row outside; both are held.
struct GrowingRing {
  int around;    // particles of a circle; at least 3
  int rows;      // of triangles beyond the second circle; at least 1
  double plate;  // radius of its rim [m]

  double radius(int circle) const;                    // m
  double edge() const { return radius(rows + 1); }    // radius of the free edge [m]
  int held() const { return 2 * around; }             // particles, the first ones
  PerParticle3 rest() const;                          // from inside out, in the plane z = 0 [m]
  std::vector<std::array<int, 3>> triangles() const;  // normals +z
};

/// How far the free edge sags in the mean, times rigidity/(weight per area times its radius^4) [1],
/// if hinges alone resist bending: one of length L whose two triangles have the area A together
/// stores rigidity L^2 theta^2/(2 A) at a small angle theta. Each corner bears a third of its
/// triangles' weight. On an equilateral lattice this is a plate of Poisson's ratio -1/3: a hinge
/// turns by sqrt(3)/2 L (k_n - k_t/3), of the curvatures across and along it.
double sag_of_hinges(const GrowingRing& ring);
constexpr double poisson_of_hinges = -1.0 / 3;

}  // namespace foldproof::oracles
