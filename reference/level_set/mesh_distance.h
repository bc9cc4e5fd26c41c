// Exact signed distance to a closed triangle mesh: the nearest vertex, edge or face, and the sign.
#pragma once

#include <array>
#include <limits>
#include <memory>
#include <vector>

#include "reference/level_set/signed_distance.h"
#include "reference/mesh/box_tree.h"
#include "reference/mesh/nearest_point.h"
#include "reference/mesh/triangle_mesh.h"

namespace foldproof {

/// A mesh prepared for queries. The sign is the sign of (p - nearest point) . n (Baerentzen and
/// Aanaes 2005): n is the face normal, at an edge the sum of both, at a vertex their angle-weighted
/// sum. This sign is correct everywhere on a closed, consistently oriented surface without
/// self-intersections, but not on other surfaces, see bodies/closed_mesh.h.
///
/// Accuracy: |phi| to a few roundings of |p| and of the mesh's extent. Closer than that the
/// sign is undefined.
struct MeshDistance {
  PerParticle3 x;                   // 3 x N [m]
  std::vector<Triangle> triangles;  // M
  BoxTree tree;                     // over the triangles
  std::vector<Corners3> corners;    // M, in the order of the tree
  // M, in the order of the tree: one per Feature [1]
  std::vector<std::array<Vector3, 7>> normals;
  double resolution = 0;  // below this distance directions are rounding error [m]

  Distance at(const Vector3& p) const;
};

/// x: 3 x N [m]; the face of a zero-area triangle is never nearest and has no weight in normals.
MeshDistance make_mesh_distance(PerParticle3 x, std::vector<Triangle> triangles);

/// The nearest feature closer than `bound` [m]; among several at the same distance, the first in
/// the tree.
NearestFeature nearest_feature(const MeshDistance& mesh, const Vector3& p, double bound);

/// The signed distance to a nearest feature that was found.
Distance signed_distance(const MeshDistance& mesh, const NearestFeature& nearest, const Vector3& p);

/// A solid bounded by a mesh; copies share it.
struct MeshSolid {
  std::shared_ptr<const MeshDistance> mesh;
  Distance at(const Vector3& p) const { return mesh->at(p); }
};

}  // namespace foldproof
