// A level set from triangles that do not form a closed surface; its surface is where the winding
// number crosses 1/2.
#pragma once

#include <memory>

#include "reference/fast/team.h"
#include "reference/level_set/mesh_grid.h"
#include "reference/mesh/triangle_soup.h"

namespace foldproof {

/// The triangles with nonzero area, oriented consistently across edges that two triangles share; in
/// each patch, the larger part of the area keeps its orientation. Vertices at one place are one.
std::vector<Triangle> orient_triangles(const TriangleSoup& soup);

/// The same, with the number in the soup of each triangle, and the patches: lists of places in
/// `triangles`.
struct OrientedPatches {
  std::vector<Triangle> triangles;
  std::vector<int> numbers;
  std::vector<std::vector<int>> patches;
};
OrientedPatches oriented_patches(const TriangleSoup& soup);

/// The same, with normals outward: a patch within which the winding number would be negative, for
/// lack of another around it, is turned, together with the patches that it encloses. A cavity stays
/// one, also in a body that is inside out as a whole. Flat patches, which have no inside alone, are
/// decided together.
OrientedPatches outward_patches(const TriangleSoup& soup);

/// repair = "winding". Inside is where the generalised winding number of the outward triangles is
/// at least 1/2, at every node. A node with a neighbour on the other side gets its exact distance
/// to the triangles if that is at most one cell. Otherwise no triangle separates the two, and it
/// gets the distance to where the winding number, taken as linear along the axes, crosses 1/2: a
/// membrane closes the surface over holes. All other nodes are marched; method.band is not used,
/// and triangles inside the solid have no effect. Cost: one winding number per node. Throws
/// InputError where no node is inside. The same bits for every team.
std::shared_ptr<const Grid> make_repaired_grid(const TriangleSoup& soup, const GridMethod& method,
                                               const Team& team = {});

/// Treatment of a mesh that does not separate inside from outside.
enum class Repair { refuse, winding };

/// The level set of a body. refuse: the mesh must be closed, or make_closed_mesh throws; winding:
/// any triangles, by make_repaired_grid.
std::shared_ptr<const Grid> make_level_set(const TriangleSoup& soup, const GridMethod& method,
                                           Repair repair, const Team& team = {});

}  // namespace foldproof
