// Files of triangle meshes in and out: Wavefront OBJ and PLY.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "reference/mesh/triangle_mesh.h"
#include "reference/mesh/triangle_soup.h"

namespace foldproof {

/// Triangles by the name of their group: those of all faces after 'g NAME ...', 'o NAME' or 'usemtl
/// NAME', until the next record of the same kind. A name that occurs twice is one group; a face may
/// belong to several.
using FaceGroups = std::map<std::string, std::vector<int>>;

struct MeshFile {
  TriangleSoup soup;
  FaceGroups groups;  // of an OBJ file
  // M: of an OBJ file whose corners all have texture coordinates, those, in its units
  std::vector<FlatTriangle> textures;
  std::optional<double> time;  // if a comment of a PLY file says "time T s", as exports do [s]
};

/// Whether a file without faces, such as a scan of points, is refused.
enum class Needs { faces, vertices };

/// Reads vertices [m], faces, and texture coordinates of OBJ; all else is ignored. A file that
/// begins with the line "ply" is PLY, ASCII or binary of either byte order, with x, y, z of the
/// element `vertex` and the list vertex_indices, or vertex_index, of `face` or of `tristrips`
/// (strips parted by -1); every other file is OBJ, with records v and f: negative indices count
/// back from the last vertex so far, and vertices may come after the faces that use them; comments
/// and continued lines are understood, and line ends of every system.
/// Polygons are cut by triangles_of_polygon. Numbers are read the same in every locale, to the
/// nearest double; what is too small for one is 0. A mark of UTF-8 is passed over.
/// Throws InputError "FILE:LINE: reason; what to do" (of binary data "FILE: ..."): a file that
/// cannot be read, is in UTF-16, ends early or holds no face; a malformed number or index; an index
/// out of range; a face of fewer than three vertices, or whose sides cross; a used vertex whose
/// coordinates are not finite; a file beyond the limits of text_file.h, of more than 2 million
/// vertices or 4 million triangles, with faces of more than 16 groups of one kind, or with a PLY
/// header of more than 64 elements and properties.
MeshFile read_mesh_file(const std::string& path, Needs needs = Needs::faces);

/// The same for a file's bytes; `file` names it in messages.
MeshFile read_mesh_text(std::string text, const std::string& file, Needs needs = Needs::faces);

/// The file's mesh. Throws InputError also for anything that make_triangle_mesh refuses.
TriangleMesh read_mesh(const std::string& path);

/// Writes positions (3 x N [m]) with 17 significant digits, so read_mesh recovers every bit, and
/// triangles, as OBJ. Throws InputError: a file that cannot be written, a triangle index outside
/// [0, N).
void write_obj(const std::string& path, const PerParticle3& positions,
               const std::vector<Triangle>& triangles);

}  // namespace foldproof
