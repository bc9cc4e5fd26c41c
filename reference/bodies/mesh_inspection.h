// Checks whether a mesh is usable as a body: the results of closed_mesh.h, repair.h and
// ray_parity.h together.
#pragma once

#include <string>

#include "reference/mesh/box_tree.h"
#include "reference/mesh/triangle_soup.h"

namespace foldproof {

struct MeshInspection {
  long vertices = 0, triangles = 0;
  Bounds bounds;          // m
  std::string rejection;  // why it is not a solid, as reported by make_closed_mesh; empty if it is
  int pieces = 0;         // if it is a solid
  double volume = 0;      // if it is a solid [m^3]
  // why it cannot be repaired either; empty if it can be, or needs no repair
  std::string repair_failure;
  std::string thin_parts;  // thin parts that the grid loses, in words; empty if none
  long nodes = 0;          // of the grid that a case file would get; 0 if there is none
  // nodes where ray parity contradicts the sign; nodes where its rays disagree
  long against_sign = 0, among_rays = 0;
};

/// cells: number of grid cells along the longest side. The grid's signs come from normals for a
/// solid, and from the winding number for a mesh that needs repair. Nodes within a millionth of a
/// cell of the surface are not counted.
MeshInspection inspect_mesh(const TriangleSoup& soup, int cells);

}  // namespace foldproof
