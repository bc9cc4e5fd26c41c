// PLY files: triangle meshes in, as scanners and other programs write them.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "reference/mesh/triangle_soup.h"

namespace foldproof {

/// A mesh, and its time if a comment of the file says "time T s", as `foldproof export` writes it.
struct PlyMesh {
  TriangleSoup soup;
  std::optional<double> time;  // s
};

/// Reads x, y, z of the element `vertex` (in m) and the list vertex_indices, or vertex_index, of
/// the element `face`, of an ASCII or binary PLY file of either byte order; all other properties
/// and elements are ignored. Polygons are cut into fans about their first vertex. Throws InputError
/// "FILE:LINE: reason; what to do" of the header and of ASCII, "FILE: ..." of binary data, for a
/// file that is not PLY, lacks one of these, ends too early, or has coordinates that are not finite
/// or indices out of range; also a file of more than 256 MiB, of more than 2 million vertices, 4
/// million triangles, or 64 elements and properties.
PlyMesh read_ply(const std::string& path);

/// The same of a file that may also hold vertices without a face: points.
PlyMesh read_ply_or_points(const std::string& path);

/// The same for a file's bytes; `file` names it in messages.
PlyMesh read_ply_text(std::string_view text, const std::string& file);

}  // namespace foldproof
