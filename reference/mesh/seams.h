// Sewing: panels whose vertices coincide become one cloth.
#pragma once

#include <string>

#include "reference/mesh/triangle_soup.h"

namespace foldproof {

/// The numbering of a mesh before its seams were closed.
struct UnsewnMesh {
  std::vector<Triangle> triangles;  // M, in the order of the sewn ones; empty: nothing was sewn
  Eigen::Index vertices = 0;
  double distance = 0;  // of vertices that were merged, at most [m]
};

/// Merges every vertex that lies within `distance` [m] of an earlier vertex that is not merged
/// itself into the first such vertex. So no vertex moves farther than `distance`, nor twice.
/// Triangles keep their numbers and places in the file; the remaining vertices keep their places in
/// the file and are renumbered in order; the origin has their numbers there. Throws InputError
/// "FILE:LINE: ..." for a distance that is not > 0 or not finite, coordinates that are not finite,
/// and a triangle with two corners that merge.
TriangleSoup close_seams(TriangleSoup panels, double distance);

/// How many vertices on the border lie near an earlier one there, and with which distance
/// close_seams joins them, in words; "" if none do. Near: within a millionth of the mesh's extent,
/// or a tenth of the shortest edge of the border. table: of a case file, "[cloth]" or "[[object]]".
/// unit: of the mesh's file [m].
std::string open_seams_in_words(const TriangleMesh& mesh, const std::string& table = "[cloth]",
                                double unit = 1);

/// Joins the same vertices in every frame (3 x N [m]) of a mesh in motion: the ones that
/// close_seams joins in the first.
void close_seams_in_motion(std::vector<PerParticle3>& frames, std::vector<Triangle>& triangles,
                           double distance, const std::string& file);

}  // namespace foldproof
