// Meshes made by code: flat sheets in seven patterns, the disc, the open cylinder, the sphere, a
// seated statue, one hinge; and the isometric folding of a sheet into pleats. The same arguments
// give the same mesh, bit for bit. Every argument is checked; InputError names it and its value.
#pragma once

#include "reference/mesh/triangle_mesh.h"

namespace foldproof {

enum class SheetPattern {
  // every cell split along the rising diagonal (lower left to upper right): interior degree 6
  one_diagonal,
  // rows of alternating diagonal: rising in even rows, falling in odd rows: interior degree 6
  alternating,
  union_jack,   // rising and falling as on a chequerboard: interior degree 8 and 4
  criss_cross,  // four triangles a cell about a vertex in its centre: interior degree 8 and 4
  // rows offset by half an edge, half triangles at x = 0 and x = width: interior degree 6
  equilateral,
  jittered,  // equilateral, interior vertices displaced at random, then Delaunay
  // random interior vertices with a least distance, regular ones on the border, Delaunay
  random_delaunay,
};

/// A rectangular sheet in the plane z = 0: x in [0, width], y in [0, height], normals +z.
struct Sheet {
  SheetPattern pattern = SheetPattern::one_diagonal;
  double width = 0;  // [m]
  // [m]; equilateral and jittered: 0 means rows * sqrt(3)/2 * width/columns
  double height = 0;
  int columns = 0, rows = 0;  // cells along x and along y; at least 1
  double jitter = 0;  // jittered only: largest displacement over width/columns [1]; in [0, 0.5)
  unsigned seed = 0;  // jittered and random_delaunay only
  // patterns of squares only: last cell's width over the first one's, along x and y [1]
  double grading = 1;
};

/// Vertices are numbered row by row from y = 0 up, from x = 0 within a row; triangles follow
/// their vertices.
///
/// equilateral: even rows have columns + 1 vertices, odd rows columns + 2, the first and the last
/// of them on the border. With height 0 all edges are width/columns long, except those of the half
/// triangles (1/2 and sqrt(3)/2 of it); a given height scales y. jittered: displacements are
/// uniform in a disc, which is scaled like y.
/// grading: cells grow by a constant factor from one to the next, along x and along y.
/// random_delaunay: columns and rows fix the vertices on the border; no two vertices are closer
/// than 0.8 of the shorter side of a cell, which fills the sheet with about 1.1 columns * rows
/// vertices when cells are square (sides 1:4 at most).
TriangleMesh make_sheet(const Sheet& sheet);

/// A flat disc in the plane z = 0 about the origin, normals +z: ring k of `rings` has 6 k vertices;
/// 6 rings^2 triangles. radius [m].
TriangleMesh make_disc(double radius, int rings);

/// An open cylinder about the y axis, y in [0, height], normals outward: `around` (at least
/// 3) by `along` rectangles, each split along one diagonal; rings of vertices from y = 0 up.
/// radius, height [m].
TriangleMesh make_cylinder(double radius, double height, int around, int along);

/// A sphere about the origin: the icosahedron with its edges halved `subdivisions` (0 to 9) times.
/// It has 20 * 4^subdivisions triangles, and all vertices at the distance radius [m], normals
/// outward. Vertices of a coarser level keep their numbers in all finer ones.
TriangleMesh make_icosphere(double radius, int subdivisions);

/// A sphere about the origin: the icosahedron with its edges divided into `divisions` (1 to 512)
/// parts, carried out to the distance radius [m]: 10 divisions^2 + 2 vertices, normals outward.
TriangleMesh make_geodesic_sphere(double radius, int divisions);

/// The mesh with every edge divided into `parts` >= 1, which makes parts^2 triangles of each, in
/// its plane. Old vertices keep their numbers; parts - 1 on each edge come next, from a to b, then
/// those inside triangles.
TriangleMesh divide_edges(const TriangleMesh& mesh, int parts);

/// A seated figure with crossed legs, arms in the lap, head and low folds; closed, genus 0, normals
/// outward, y up, facing +z, y in [0, height] [m], about 0.9 height wide. It stands in for the
/// Buddha of BMF03 figures 3 and 4. The icosphere of `subdivisions` (3 to 8; 3 is too coarse for
/// the knees) is carried along rays from an inner axis to an implicit surface, a smooth union of
/// ellipsoids and limbs. It is then relaxed along the surface, with edges flipped where that
/// improves the triangles: the least angle is about 25 degrees.
TriangleMesh make_statue(double height, int subdivisions);

/// The same figure from the geodesic sphere of `divisions`, with triangles of more uniform size:
/// the smallest one, not the mean, limits the steps of an explicit scheme. `divisions` is 15 to
/// 256, with a divisor from 15 to 29: the mesh with that number of divisions is relaxed first, then
/// divided.
TriangleMesh make_even_statue(double height, int divisions);

/// Two triangles folded at the angle theta [rad], |theta| < pi, about their shared edge of length L
/// [m]. Particles 0, 1, 2, 3 are x1, x2, x3, x4 of struct Hinge; theta is measured from N1 to N2
/// about E = x4 - x3, as in BMF03 section 4:
///     x1 = (0.4 L, 0.9 L, 0)                             x3 = (0, 0, 0)
///     x2 = (0.7 L, -0.6 L cos(theta), -0.6 L sin(theta))   x4 = (L, 0, 0)
/// The two triangles differ, and neither is isosceles, so that no symmetry hides an error.
TriangleMesh make_hinge(double length, double angle);

/// Positions (3 x N [m]) of a flat sheet folded into straight pleats along grid columns, to serve
/// as a sculpted rest shape. The panels between fold lines, `columns_per_pleat` cells wide, stay
/// rigid: edge lengths and angles within triangles are kept to rounding. Panels rise and fall in
/// turn by angle/2 about the y axis, so that neighbours differ by `angle` [rad], |angle| < pi;
/// positive: the first panel rises towards +z. The sheet must be one whose triangles do not cross
/// the fold lines: one_diagonal, alternating, union_jack or criss_cross.
PerParticle3 pleated_positions(const TriangleMesh& sheet, int columns_per_pleat, double angle);

/// Throws InputError "NAME is VALUE; REMEDY", for all functions of this file.
[[noreturn]] void reject_argument(const std::string& name, double value, const std::string& remedy);

}  // namespace foldproof
