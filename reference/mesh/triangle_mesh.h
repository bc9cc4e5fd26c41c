// A triangle mesh with boundary, of any topology, oriented and manifold; its edges and hinges.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "reference/types.h"

namespace foldproof {

using Triangle = std::array<int, 3>;  // particles, counter-clockwise seen from the front

struct Edge {
  int a, b;                      // particles, a < b
  std::array<int, 2> triangles;  // one or two triangles; the second is -1 on the boundary
};

//      x1
//     /  \      triangles (x1, x3, x4) and (x2, x4, x3) share the edge 3-4 (BMF03 figure 1)
//   x3 -- x4
//     \  /
//      x2
struct Hinge {
  std::array<int, 4> particles;  // x1, x2, x3, x4
  int edge;                      // index into TriangleMesh::edges
};

struct TriangleMesh {
  PerParticle3 rest;                // 3 x N rest positions [m]
  std::vector<Triangle> triangles;  // M
  std::vector<Edge> edges;          // sorted by (a, b)
  std::vector<Hinge> hinges;  // one for each edge with two triangles, in the order of the edges

  int particles() const { return int(rest.cols()); }
};

/// The lines from which the parts of a mesh were read, for error messages. Empty for meshes made by
/// code; binary files have a name, and no lines.
struct MeshOrigin {
  std::string file;
  std::vector<int> vertex_lines;    // N, 1-based
  std::vector<int> triangle_lines;  // M, 1-based
  // N, in the file, 1-based, if vertices were left out; empty: each its own
  std::vector<int> vertex_numbers = {};
};

/// Finds edges and hinges of the triangles over the N rest positions (3 x N [m]).
/// Refuses anything but an oriented manifold with boundary; the InputError names origin's file and
/// line, and the reason: no triangles, indices out of range, NaN or infinite coordinates, unused
/// vertices, zero-area triangles, two of the same three corners, edges with three triangles or more,
/// two neighbours of opposite orientation, a vertex whose triangles do not form one fan.
TriangleMesh make_triangle_mesh(PerParticle3 rest, std::vector<Triangle> triangles,
                                const MeshOrigin& origin = {});

/// The same, but a vertex may have several fans, for splitting (split_fans.h).
TriangleMesh make_mesh_of_fans(PerParticle3 rest, std::vector<Triangle> triangles,
                               const MeshOrigin& origin = {});

/// Corner k of triangle t is number 3 t + k. Corners of one vertex belong to the same fan when
/// their triangles share an edge there, directly or through others: for each corner (3 M) the first
/// one of its fan.
std::vector<int> fans_of(const TriangleMesh& mesh);

/// Whether the triangle's area at x exceeds 1e-12 of its longest side squared, in any unit.
bool has_area(const PerParticle3& x, const Triangle& triangle);

/// Area of each triangle at the positions x (3 x N [m]); M values [m^2].
Eigen::VectorXd triangle_areas(const std::vector<Triangle>& triangles, const PerParticle3& x);

/// The least height of a triangle at the positions x [m]; infinite without triangles.
double smallest_height(const std::vector<Triangle>& triangles, const PerParticle3& x);

/// Lumped masses: a third of each adjacent triangle's rest area times the area density
/// [kg/m^2]; N values [kg].
PerParticle lumped_masses(const TriangleMesh& mesh, double density);

/// Rest length of each edge [m], and the sum of the full rest areas of its one or two
/// triangles [m^2].
Eigen::VectorXd rest_lengths(const TriangleMesh& mesh);
Eigen::VectorXd edge_areas(const TriangleMesh& mesh);

/// V - E + F.
int euler_characteristic(const TriangleMesh& mesh);

}  // namespace foldproof
