// The generalised winding number: how many times triangles wrap around a point, closed or not
// (Jacobson et al. 2013).
#pragma once

#include <vector>

#include "reference/level_set/mesh_distance.h"

namespace foldproof {

/// The sum of the triangles' solid angles seen from p, over 4 pi [1]: 1 inside and 0 outside a
/// closed surface whose normals point outward, and in between near holes.
double winding_number(const PerParticle3& x, const std::vector<Triangle>& triangles,
                      const Vector3& p);

/// Far-field approximation of a tree node: a patch at `centre` with the sum of its area normals.
struct Dipole {
  Vector3 centre;  // of area [m]
  Vector3 area;    // sum of half cross products, outward [m^2]
  // sum of area (x) (its triangle's centre - centre): the spread of the patch [m^3]
  Eigen::Matrix3d slope;
  double radius;  // from centre to the farthest corner [m]
};

/// One per node of the mesh's tree.
std::vector<Dipole> make_dipoles(const MeshDistance& mesh);

/// The winding number from the tree (Barill et al. 2018). A node farther away than `far` times its
/// radius is approximated by its dipole and quadrupole; a nearer leaf is summed triangle by
/// triangle. The error is below 0.5 far^-2 on the statue, whole and with holes (check
/// level-set.winding-tree-error-is-bounded); it is larger where many triangles overlap.
double winding_number(const MeshDistance& mesh, const std::vector<Dipole>& dipoles,
                      const Vector3& p, double far);

}  // namespace foldproof
