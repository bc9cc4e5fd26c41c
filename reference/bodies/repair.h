// A level set from triangles that do not close: the surface is where the winding number
// passes one half.
#pragma once

#include <memory>

#include "reference/level_set/mesh_grid.h"
#include "reference/mesh/triangle_soup.h"

namespace foldproof {

/// The triangles that have area, each turned so that it agrees with its neighbours across edges of
/// two triangles; of every patch so found the larger part of its area keeps its orientation.
std::vector<Triangle> orient_triangles(const TriangleSoup& soup);

/// repair = "winding". Inside is where the generalised winding number of the oriented triangles is
/// at least 1/2, at every node. A node next to one on the other side gets its exact distance to the
/// triangles where that is at most a cell; else no triangle parts the two, and the distance to
/// where the winding number, taken to be linear along the axes, passes 1/2: over holes a membrane
/// closes the surface. All else is marched; method.band is not used, and triangles within the solid
/// leave no trace. Costs a winding number a node. Throws InputError where no node is inside.
std::shared_ptr<const Grid> make_repaired_grid(const TriangleSoup& soup, const GridMethod& method);

/// What to do with a mesh that does not part inside from outside.
enum class Repair { refuse, winding };

/// The level set of a body: refuse: of a closed mesh, with the refusals of make_closed_mesh;
/// winding: of any triangles, as make_repaired_grid makes it.
std::shared_ptr<const Grid> make_level_set(const TriangleSoup& soup, const GridMethod& method,
                                           Repair repair);

}  // namespace foldproof
