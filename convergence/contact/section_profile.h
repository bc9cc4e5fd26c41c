// A line across a cloth, and what a quantity of its particles is along it.
#pragma once

#include <vector>

#include "reference/mesh/triangle_mesh.h"

namespace foldproof {

/// Where the line crosses an edge: at (1 - t) of particle a and t of particle b.
struct Crossing {
  int a, b;
  double t;
};

/// Crossings in their order along the line, and the length from the first to each, at rest [m].
struct MeshSection {
  std::vector<Crossing> crossings;
  std::vector<double> length;
};

/// The longest line in which the plane through the middle of the rest shape, normal to the axis (0
/// x, 1 y, 2 z), cuts it; empty where the shape is flat along the axis. A plane that meets a
/// particle is moved aside by a billionth of the extent.
MeshSection section_of(const TriangleMesh& mesh, int axis);

/// The values (N) along the section, at `count` >= 2 places equally far from the next; empty for
/// an empty section.
std::vector<double> along(const MeshSection& section, const PerParticle& values, int count);

}  // namespace foldproof
