#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

// Bending stiffness of a flat mesh of hinges at small curvature, from the definition of one hinge.
// With
//   w = (K11 x^2 + 2 K12 x y + K22 y^2)/2,   k = (K11, K22, 2 K12) [1/m],
// each hinge turns by theta = q.k and stores ke c theta^2/4, c = |E|^2/(|N1| + |N2|); the sum over
// a cell is
//   energy per area = ke/2 k.R k,   R in units of ke [1].
// A periodic mesh has a cell; if the cell has several vertices, these may leave the curved surface
// by a periodic displacement. "forced" is R without that displacement, "relaxed" with the one of
// least energy.

namespace foldproof::oracles {

/// A corner of a periodic mesh: which vertex of the cell, and how many periods away.
struct PeriodicCorner {
  int site = 0;
  int along_a = 0, along_b = 0;
};

/// A plane periodic mesh; triangles counter-clockwise.
struct PeriodicMesh {
  Eigen::Vector2d period_a, period_b;  // [m]
  std::vector<Eigen::Vector2d> sites;  // of one cell [m]
  std::vector<std::array<PeriodicCorner, 3>> triangles;
};

/// Whether the square in column i and row j of a block is split along its rising diagonal.
using Rises = bool (*)(int i, int j);

/// A repeated block of columns x rows rectangles of width x height [m]; each is split in two.
struct SplitBlock {
  double width = 1, height = 1;
  int columns = 1, rows = 1;
  Rises rises = nullptr;
};
PeriodicMesh split_rectangles(const SplitBlock& block);
PeriodicMesh crossed_squares(double side);        // four triangles a square, about its centre
PeriodicMesh equilateral_triangles(double edge);  // edges at 0, 60 and 120 degrees

/// R, symmetric, 3 x 3 [1]. InputError if an edge has no second triangle or a triangle no area.
Eigen::Matrix3d forced_rigidity(const PeriodicMesh& mesh);
Eigen::Matrix3d relaxed_rigidity(const PeriodicMesh& mesh);

/// D/ke of bending to a cylinder, curved along the direction at `angle` [rad] to x and held so [1].
double cylinder_rigidity(const Eigen::Matrix3d& R, double angle);

/// B/ke of a narrow strip along that direction, whose long edges are free to curve [1].
double strip_rigidity(const Eigen::Matrix3d& R, double angle);

/// A ribbon: periodic along its length, with two free edges.
struct RibbonRigidity {
  double bending;   // EI over ke, of its whole width, which is free to curve [m]
  double twisting;  // GJ over ke, of its whole width [m]
};

/// Of equilateral triangles with rows of edges along the ribbon, `rows` of triangles wide: a free
/// edge has no hinge. The rows of vertices leave the curved surface to minimise the energy.
RibbonRigidity equilateral_ribbon(double edge, int rows);

/// Least and greatest cylinder_rigidity over all directions, to 2e-6 of the greatest.
struct RigidityRange {
  double least, greatest;
};
RigidityRange cylinder_range(const Eigen::Matrix3d& R);

/// A finite flat mesh without repetition.
struct PlaneSheet {
  Eigen::Matrix2Xd points;                 // [m]
  std::vector<std::array<int, 4>> hinges;  // x1, x2, x3, x4: opposite corners, then the edge's ends
  std::vector<char> counted;               // one per hinge: whether its energy counts
  std::vector<char> held;                  // one per point: whether it stays on the curved surface
};

/// D/ke of the counted hinges at small curvature along `angle` [rad], each with a third of its two
/// triangles' areas [1]. Forced: all points on the cylinder. Relaxed: points that are not held
/// leave it to minimise the energy of all hinges (a sparse direct solve).
double forced_cylinder_rigidity(const PlaneSheet& sheet, double angle);
double relaxed_cylinder_rigidity(const PlaneSheet& sheet, double angle);

}  // namespace foldproof::oracles
