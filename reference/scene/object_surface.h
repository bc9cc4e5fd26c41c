// Triangulated surfaces of the closed-form solids, for pictures and files.
#pragma once

#include <vector>

#include "reference/mesh/triangle_mesh.h"
#include "reference/types.h"

namespace foldproof {

/// Triangles point outward.
struct ObjectSurface {
  PerParticle3 vertices;  // 3 x V [m]
  std::vector<Triangle> triangles;
};

/// A square of the plane z = 0 about the origin, facing +z. side [m].
ObjectSurface square_surface(double side);

ObjectSurface box_surface(const Vector3& half_extents);  // m

ObjectSurface sphere_surface(double radius);  // m

/// About the z axis; as Capsule and Torus of reference/level_set/signed_distance.h. [m]
ObjectSurface capsule_surface(double radius, double half_length);
ObjectSurface torus_surface(double ring_radius, double tube_radius);

}  // namespace foldproof
