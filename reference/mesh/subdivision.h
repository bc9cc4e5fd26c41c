// Finer meshes over a cloth, as it is drawn: each triangle becomes four, a level at a time.
#pragma once

#include <Eigen/SparseCore>

#include "reference/mesh/triangle_mesh.h"

namespace foldproof {

enum class SubdivisionRule {
  midpoint,  // new vertices halve the edges; the surface stays what it was
  loop       // Loop (1987), with his boundary rules: smooth, and the old vertices move too
};

/// A finer mesh and how its points follow from those of the cloth.
struct Subdivision {
  std::vector<Triangle> triangles;      // four for each one of the cloth and level
  Eigen::SparseMatrix<double> weights;  // N fine x N: each row sums to 1

  /// The fine points, or their velocities: 3 x N fine. x: 3 x N.
  PerParticle3 of(const PerParticle3& x) const { return x * weights.transpose(); }
};

/// `levels` >= 0; 0 is the cloth itself. Old particles keep their numbers, then comes a vertex for
/// each edge. Throws InputError for levels < 0 or more than 8.
Subdivision subdivision(const TriangleMesh& mesh, SubdivisionRule rule, int levels);

}  // namespace foldproof
