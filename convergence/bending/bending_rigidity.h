// Parts of the study bending-rigidity: a sheet wrapped round a cylinder, gently bent sheets,
// irregular triangles.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "convergence/study.h"
#include "reference/mesh/shapes.h"
#include "reference/scene/scene.h"
#include "verification/oracles/definitions.h"
#include "verification/oracles/homogenised_bending.h"
#include "verification/specimens/probe.h"

namespace foldproof {

// Regular sheets bent on purpose, and what a cell of them stores.

/// A regular way to cut a sheet into triangles, and the same in the oracle's words.
struct RegularPattern {
  std::string name, words;
  SheetPattern pattern;
  double cell_height;               // over a cell's width; 0: as equilateral triangles have it [1]
  double longest_edge;              // over a cell's width [1]
  oracles::PeriodicMesh (*cell)();  // with cells one metre wide
  // whether a vertex is one of the cell's second kind
  bool (*second_site)(double column, double row);
};

const std::vector<RegularPattern>& regular_patterns();

/// How a flat sheet is laid on a cylinder: the sheet's plane touches it along the line
/// through the origin.
struct Wrap {
  double direction = 0;  // of the curvature, from x [rad]
  double curvature = 0;  // [1/m]
  double offset = 0;     // of the vertices of the second kind, outward [m]
};

/// Sheets of one pattern in two widths and two heights, n and 2 n cells. On a cylinder, equal cells
/// lie alike wherever they are; the energy is therefore a n_x n_y + b n_x + c n_y + d, and the
/// mixed difference of four sheets is that of the cells in their inner parts, without any border.
class FourSheets {
 public:
  /// n even, so that whole periods are added. width: of a cell [m]; ke [J].
  FourSheets(const Subject& subject, const RegularPattern& pattern, int n, double width, double ke);

  /// Energy per area of the inner cells when each vertex of the flat sheet goes where `bend` says
  /// [J/m^2]. bend: (rest position [m], of the second kind) -> position [m].
  double energy_per_area(const std::function<Vector3(const Vector3&, bool)>& bend) const;

  double energy_per_area(const Wrap& wrap) const;

 private:
  struct Specimen {
    PerParticle3 rest;  // 3 x N [m]
    Probe probe;
    double sign;  // in the mixed difference
  };
  const RegularPattern& pattern_;
  double width_, height_;  // of a cell [m]
  double area_;            // of the inner cells [m^2]
  std::vector<Specimen> specimens_;
};

/// Where the cylinder takes a vertex.
Vector3 wrap_position(const Wrap& wrap, const Vector3& rest, bool second);

/// D/ke with all vertices on the cylinder [1]; wrap.offset is not used.
double forced_rigidity_of(const FourSheets& sheets, Wrap wrap, double ke);

/// D/ke with the vertices of the second kind at the offset of least energy, from three of them [1];
/// wrap.offset is the distance at which they are tried.
double relaxed_rigidity_of(const FourSheets& sheets, Wrap wrap, double ke);

/// The oracle's R from the energies of six small quadratic surfaces, `curvature` [1/m] large [1].
Eigen::Matrix3d measured_tensor(const FourSheets& sheets, double curvature, double ke);

/// D/ke of a whole square sheet of n x n cells, its border included, curved along x by 0.3 1/m [1].
constexpr double whole_side = 0.31;  // m
double whole_sheet_rigidity(const Subject& subject, const RegularPattern& pattern, int n,
                            double ke);

// A flat sheet of any mesh, curved so gently that heights over the plane say all.

constexpr double gentle_side = 0.53;                     // of the sheets [m]
constexpr double gentle_curvature = 1e-3 / gentle_side;  // [1/m]
// the square of the largest slope, 1e-3 times the diagonal over the side, twice [1]
constexpr double gentle_bound = 4e-6;

/// Its bending energy at small curvature. Hinges near the border do not count; vertices near it are
/// held when the others settle.
class GentleSheet {
 public:
  /// width: of a cell [m].
  GentleSheet(const Subject& subject, TriangleMesh mesh, double width);

  /// D/ke of a cylinder curved along `angle` [rad] [1]: with all vertices on it, or with those
  /// inside where the subject's forces vanish.
  double forced(double angle) const;
  double relaxed(double angle) const;

  /// The same sheet in the oracle's words.
  const oracles::PlaneSheet& flat() const { return flat_; }

 private:
  Eigen::VectorXd cylinder(double angle) const;                     // heights of all vertices [m]
  PerParticle3 positions_at(const Eigen::VectorXd& heights) const;  // 3 x N [m]
  double rigidity(const Eigen::VectorXd& heights) const;  // D/ke of the counted hinges [1]
  // force across the sheet, 0 where held [N]
  Eigen::VectorXd pull(const Eigen::VectorXd& heights) const;

  const Subject& subject_;
  Scene scene_;
  Probe probe_;
  oracles::PlaneSheet flat_;
  double width_;     // of a cell [m]
  double area_ = 0;  // a third of the counted hinges' triangles [m^2]
};

// Part of bending-rigidity: sheets whose triangles do not repeat themselves.

/// Adds the findings, the figure and the table of jittered and random sheets to those of
/// the regular ones.
void add_irregular_rigidity(const Subject& subject, Tier tier, const Progress& progress,
                            StudyResult& result);

}  // namespace foldproof
