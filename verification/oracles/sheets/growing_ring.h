// A ring of triangles that grow outward: the cloth around the plate of a drape test.
#pragma once

#include <array>
#include <vector>

#include "reference/types.h"

namespace foldproof::oracles {

/// An equilateral lattice, mapped by the exponential: circles of equally many particles, each
/// rotated by half a spacing against the one before. As their number grows, every triangle becomes
/// equilateral, its size proportional to the distance from the axis. The first circle is half a row
/// of triangles inside the plate's rim, the second half a row outside; both are held.
struct GrowingRing {
  int around;    // particles of a circle; at least 3
  int rows;      // of triangles beyond the second circle; at least 1
  double plate;  // radius of its rim [m]

  double radius(int circle) const;                    // m
  double edge() const { return radius(rows + 1); }    // radius of the free edge [m]
  int held() const { return 2 * around; }             // number of held particles, which come first
  PerParticle3 rest() const;                          // from inside out, in the plane z = 0 [m]
  std::vector<std::array<int, 3>> triangles() const;  // normals +z
};

/// Mean sag of the free edge, times rigidity/(weight per area times its radius^4) [1], if hinges
/// alone resist bending. A hinge of length L whose two triangles have the total area A stores
/// rigidity L^2 theta^2/(2 A) at a small angle theta. Each corner bears a third of its triangles'
/// weight. On an equilateral lattice this is a plate of Poisson's ratio -1/3: a hinge turns by
/// sqrt(3)/2 L (k_n - k_t/3), with the curvatures k_n across and k_t along it.
double sag_of_hinges(const GrowingRing& ring);
constexpr double poisson_of_hinges = -1.0 / 3;

}  // namespace foldproof::oracles
