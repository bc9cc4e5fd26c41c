// Wavefront OBJ files: triangle meshes in and out.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "reference/mesh/triangle_mesh.h"
#include "reference/mesh/triangle_soup.h"

namespace foldproof {

/// Reads the vertices (v, in m) and faces (f) of an OBJ file; all other records are ignored, and so
/// are w, colours, texture and normal indices. Polygons are cut into fans about their first vertex,
/// which is right for convex ones. Negative indices count back from the last vertex so far;
/// vertices may also come after the faces that use them. Comments, CR LF and continued lines are
/// understood. Numbers are read the same in every locale, to the nearest double.
/// Throws InputError "FILE:LINE: reason; what to do": a file that cannot be read or holds no face,
/// a malformed number or index, a face with fewer than three vertices, an index that is 0 or out of
/// range, and anything that make_triangle_mesh refuses; also a file beyond the limits of
/// text_file.h, of more than 2 million vertices or 4 million triangles, or with faces of more than
/// 16 groups of one letter.
TriangleMesh read_obj(const std::string& path);

/// Reads the same file without the checks of make_triangle_mesh; refuses only coordinates that
/// are not finite.
TriangleSoup read_obj_soup(const std::string& path);

/// The same for a body: vertices that no triangle uses are left out, also if they are not finite.
TriangleSoup read_body_soup(const std::string& path);

/// Triangles by the name of their group, numbered as by read_obj: the triangles of all faces after
/// 'g NAME ...' or 'o NAME', until the next record of the same letter. A name that occurs twice is
/// one group; a face may belong to several.
using FaceGroups = std::map<std::string, std::vector<int>>;
/// Throws InputError "FILE:LINE: ..." for syntax that read_obj refuses, and for more than 16
/// names in a record.
FaceGroups read_obj_groups(const std::string& path);

/// The same three for the text of a file; `file` names it in messages.
TriangleMesh read_obj_text(std::string_view text, const std::string& file);
TriangleSoup read_obj_soup_text(std::string_view text, const std::string& file);
FaceGroups read_obj_groups_text(std::string_view text, const std::string& file);

/// Writes positions (3 x N [m]) with 17 significant digits, so read_obj recovers every bit, and
/// triangles. Throws InputError: a file that cannot be written, a triangle index outside [0, N).
void write_obj(const std::string& path, const PerParticle3& positions,
               const std::vector<Triangle>& triangles);

}  // namespace foldproof
