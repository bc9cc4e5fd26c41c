// Finer meshes of a cloth for rendering: each triangle becomes four per level.
#pragma once

#include <Eigen/SparseCore>

#include "reference/mesh/triangle_mesh.h"

namespace foldproof {

enum class SubdivisionRule {
  midpoint,  // new vertices halve the edges; the surface does not change
  loop       // Loop (1987), with his boundary rules: smooth, and the old vertices move too
};

/// A finer mesh, and the weights that give its points from the points of the cloth.
struct Subdivision {
  std::vector<Triangle> triangles;      // four per cloth triangle and level
  Eigen::SparseMatrix<double> weights;  // N fine x N: each row sums to 1

  /// The fine points, or their velocities: 3 x N fine. x: 3 x N.
  PerParticle3 of(const PerParticle3& x) const { return x * weights.transpose(); }
};

/// `levels` >= 0; 0 is the cloth itself. Old particles keep their numbers; one vertex per edge
/// follows. Throws InputError for levels < 0 or more than 8.
Subdivision subdivision(const TriangleMesh& mesh, SubdivisionRule rule, int levels);

}  // namespace foldproof
