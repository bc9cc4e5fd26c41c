// What a mesh is good for as a body: one look at all that closed_mesh.h, repair.h and
// ray_parity.h can say.
#pragma once

#include <string>

#include "reference/mesh/box_tree.h"
#include "reference/mesh/triangle_soup.h"

namespace foldproof {

struct MeshInspection {
  long vertices = 0, triangles = 0;
  Bounds bounds;          // m
  std::string rejection;  // why it is no solid, as make_closed_mesh says it; empty if it is one
  int pieces = 0;         // of a solid
  double volume = 0;      // of a solid [m^3]
  std::string repair_failure;  // why it cannot be repaired either; empty if it can, or need not be
  long nodes = 0;              // of the grid that case files get; 0 if there is none
  // nodes whose sign ray parity denies; where its rays do not agree
  long against_sign = 0, among_rays = 0;
};

/// cells: of the grid along the longest side. The grid's signs are those of normals for a solid,
/// and of the winding number for what has to be repaired. Nodes within a millionth of a cell of the
/// surface are not counted.
MeshInspection inspect_mesh(const TriangleSoup& soup, int cells);

}  // namespace foldproof
