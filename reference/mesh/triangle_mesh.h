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

/// The corners of a triangle in the flat pattern that it was cut from [m].
using FlatTriangle = std::array<Eigen::Vector2d, 3>;

/// The rest shape is `rest`, or, where the cloth was sewn from a flat pattern, the pattern: then
/// `rest` holds the places of the particles when it was read, and lengths, areas and masses at rest
/// are those of the pattern.
struct TriangleMesh {
  PerParticle3 rest;                // 3 x N rest positions [m]
  std::vector<Triangle> triangles;  // M
  std::vector<Edge> edges;          // sorted by (a, b)
  std::vector<Hinge> hinges;  // one for each edge with two triangles, in the order of the edges
  std::vector<FlatTriangle> pattern = {};  // M, or empty

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
/// vertices, zero-area triangles, two of the same three corners, edges with three triangles or
/// more, two neighbours of opposite orientation, a vertex whose triangles do not form one fan.
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

/// Area of each triangle at rest; M values [m^2].
Eigen::VectorXd rest_areas(const TriangleMesh& mesh);

/// Lumped masses: a third of each adjacent triangle's rest area times the area density
/// [kg/m^2], one for all triangles or M; N values [kg].
PerParticle lumped_masses(const TriangleMesh& mesh, double density);
PerParticle lumped_masses(const TriangleMesh& mesh, const std::vector<double>& densities);

/// Rest length of each edge [m], and the sum of the full rest areas of its one or two
/// triangles [m^2]. Where a seam joins sides of different lengths L1, L2 in the pattern, the length
/// at which springs of stiffness A1/L1^2 and A2/L2^2 side by side have no force together.
Eigen::VectorXd rest_lengths(const TriangleMesh& mesh);
Eigen::VectorXd edge_areas(const TriangleMesh& mesh);

/// An edge seen from one of its triangles, at rest.
struct EdgeSide {
  int triangle;   // -1: there is none
  double length;  // m
  double area;    // of the triangle [m^2]
};

/// Both sides of each edge; they have one length but at seams of a pattern.
std::vector<std::array<EdgeSide, 2>> edge_sides(const TriangleMesh& mesh);

/// V - E + F.
int euler_characteristic(const TriangleMesh& mesh);

}  // namespace foldproof
