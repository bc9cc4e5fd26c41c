// A rectangular sheet whose two short ends are clamped and pulled apart: nothing
// else compresses it.
#pragma once

#include <vector>

#include "verification/subject.h"

namespace foldproof {

/// Equilateral triangles with rows of edges along the tension, so that no slanting edge carries it.
/// The ends cannot narrow. The sheet is its own mirror image about both its middle lines: a quarter
/// of it is computed. From a clamp, particles closer than 1.1 edges are held; lengths count from
/// three quarters of an edge.
struct ClampedSheet {
  double rigidity = 0;  // D of the mesh [J]
  double young = 0;     // Y of the springs [N/m]
  double width = 0;     // W [m]
  double strain = 0;    // by which the clamps are pulled apart [1]
  int rows = 0;         // of triangles over half the width
  int half_edges = 0;   // along half the length, besides the clamp's
};

double edge_of(const ClampedSheet& sheet);    // m
double length_of(const ClampedSheet& sheet);  // L at rest [m]

/// Heights halfway between the clamps, from the middle line out.
struct Section {
  std::vector<double> places, heights;  // m
};

/// Of waves as steep as these in the mean: 2 pi (mean height^2/mean slope^2)^(1/2) [m].
double wavelength_of(const Section& section);

/// At rest in its plane, under sheet.strain.
struct ClampedFlat {
  double tension = 0;  // pull over the width [N/m]
  // across, on the middle line, against places from a clamp over the length
  std::vector<double> places, stresses;  // 1, N/m; tension is positive
  // where the sheet leaves its plane: a part of that strain; NaN if it does not
  double onset = 0;  // 1
  Section mode;      // halfway between the clamps; the largest height of the sheet is 1
  // of all particles: places [m], and heights of the mode over its unknowns
  PerParticle3 x;
  Eigen::VectorXd heights;
};

/// The flat sheet's strains go with those of the clamps; the onset is where the energy's Hessian
/// against heights loses its definiteness.
ClampedFlat clamped_flat(const Subject& subject, const ClampedSheet& sheet);

/// At rest out of its plane, from the flat rest and its mode.
struct ClampedWrinkles {
  double tension = 0;  // N/m
  Section section;
  double unbalanced = 0;  // largest force over Y strain edge [1]
  bool stable = false;    // with the sheet's symmetries
};

ClampedWrinkles clamped_wrinkles(const Subject& subject, const ClampedSheet& sheet,
                                 const ClampedFlat& flat);

}  // namespace foldproof
