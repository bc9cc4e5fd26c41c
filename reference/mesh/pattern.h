// Cloth that was sewn from a flat pattern: each triangle knows its corners in a panel.
#pragma once

#include <string>
#include <vector>

#include "reference/mesh/triangle_soup.h"

namespace foldproof {

/// The corners in the pattern, from a mesh with the same faces in the same order that lies flat
/// (z = 0, or another plane parallel to two axes). Its vertices are its own: those of a seam are
/// there once for each panel. scale: metres in a unit of the file.
/// Throws InputError "FILE:LINE: ..." for another number of triangles, a vertex that belongs to two
/// of the cloth's, a file that is not flat, and a triangle without area.
std::vector<FlatTriangle> pattern_of(const TriangleSoup& flat, double scale,
                                     const TriangleMesh& cloth);

/// The same from texture coordinates, which need no unit for a picture and one here. Throws
/// InputError for triangles without area there, and for a mesh without them.
std::vector<FlatTriangle> pattern_of_textures(std::vector<FlatTriangle> textures, double scale,
                                              const MeshOrigin& origin);

/// The pattern as a mesh of its own in the plane z = 0, its seams open; triangles keep their
/// numbers. For a mesh without a pattern, the mesh.
TriangleMesh flat_panels(const TriangleMesh& mesh);

/// The pattern of a finer mesh, whose triangles 4 t .. 4 t + 3 divide triangle t at the middles of
/// its edges (subdivision.h).
std::vector<FlatTriangle> divided_pattern(const TriangleMesh& mesh,
                                          const std::vector<Triangle>& quarters);

/// What a pattern makes of a cloth.
struct PatternFacts {
  int panels = 0;
  double area = 0;   // m^2
  double seams = 0;  // length of all seams, of the longer side [m]
  double ease = 0;   // the largest difference of a seam's two sides, over their mean [1]
  double least = 0, greatest = 0;  // lengths of the edges at x over those at rest [1]
};

/// x: 3 x N [m].
PatternFacts facts_of_pattern(const TriangleMesh& mesh, const PerParticle3& x);

}  // namespace foldproof
