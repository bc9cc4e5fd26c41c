// Names of the parts of a mesh in messages: FILE:LINE if it was read from text; numbers from 0 if
// it was made by code, or read from a binary file.
#pragma once

#include <string>

#include "reference/mesh/triangle_mesh.h"

namespace foldproof {

// To begin a message: "body.obj:17: ", or "mesh: triangle 4: ", "mesh: vertex 3: ", "mesh: ".
std::string triangle_location(const MeshOrigin& origin, int t);
std::string vertex_location(const MeshOrigin& origin, int v);
std::string mesh_location(const MeshOrigin& origin);

/// Of a vertex in its file, from 1.
int number_of(const MeshOrigin& origin, int v);

// Inside a sentence: "vertex 4 (line 4)", "the face of line 17"; files count vertices from
// 1, as OBJ does.
std::string vertex_name(const MeshOrigin& origin, int v);
std::string triangle_name(const MeshOrigin& origin, int t);
std::string edge_name(const MeshOrigin& origin, int a, int b);

/// "(x, y, z)" in four digits [m].
std::string position_name(const Vector3& x);

}  // namespace foldproof
