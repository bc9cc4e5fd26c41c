// A strip that is held cylindrical: the vertices of each row across it move together, so that a
// mesh of triangles becomes a chain of rigid-width panels. What drives the rows are the subject's
// forces, summed over each row: by virtual work, those of the constrained strip.
#pragma once

#include <string>
#include <vector>

#include "reference/mesh/shapes.h"
#include "verification/specimens/probe.h"

namespace foldproof {

/// A pattern whose rows of edges lie across the strip: bent to a cylinder, its panels stay flat.
struct StripPattern {
  std::string words;
  SheetPattern pattern;
  int along;                 // the sheet's axis along the strip: 0 or 1
  double spacing_over_edge;  // of the rows [1]
};

const std::vector<StripPattern>& strip_patterns();

constexpr double strip_length = 0.47;     // L, from the clamp to the free end [m]
constexpr double strip_ke = 0.0029;       // J
constexpr double strip_D = strip_ke / 4;  // of these patterns, curved along these axes [J]
constexpr double strip_density = 0.19;    // kg/m^2

/// Loading of the strip.
struct StripLoad {
  double gravity = 0;  // downward [m/s^2]
  double tip = 0;      // dead load on the free end, downward, over the strip's width [N/m]
  double stretch = 0;  // Y of the springs [N/m]; 0: none
};

/// Rows 0 and 1 are held level: the hinges of row 1 stand for the curvature from half a cell before
/// to half a cell behind them, so that the strip is clamped half a cell before row 1. There are
/// `panels` free ones, and L = (panels + 1/2) spacings.
class RowStrip {
 public:
  RowStrip(const Subject& subject, const StripPattern& pattern, int panels, const StripLoad& load);

  int panels() const { return panels_; }
  double spacing() const { return spacing_; }  // of the rows at rest [m]
  double width() const { return width_; }      // [m]

  /// Rows' places (2 x rows: along and up [m]) when the panels have these slopes (upward positive
  /// [rad]) and lengths [m], one of each per free panel.
  Eigen::Matrix2Xd rows(const Eigen::VectorXd& slopes, const Eigen::VectorXd& lengths) const;

  /// The subject's forces, summed over rows, and the tip's load: 2 x rows [N].
  Eigen::Matrix2Xd forces(const Eigen::Matrix2Xd& rows) const;

 private:
  StripPattern pattern_;
  int panels_;
  double spacing_, width_;
  StripLoad load_;
  Scene scene_;
  Probe probe_;
  std::vector<int> row_of_;  // each vertex
};

/// Where a strip comes to rest.
struct StripAtRest {
  Eigen::VectorXd slopes;      // of the free panels [rad]
  Eigen::VectorXd lengths;     // of the free panels [m]
  double drop = 0, reach = 0;  // of the tip from the middle of the clamp panel [m]
  double strain = 0;           // largest, of a panel [1]
  double last_step = 0;        // of Newton's method, the largest of its turns [rad] and strains [1]
};

/// For a strip with springs: Newton's method on slopes and lengths from a start, with a Jacobian by
/// central differences. It ends when steps no longer shrink; a strip not at rest after 40 has a
/// last_step that says so.
StripAtRest at_rest(const RowStrip& strip, StripAtRest start);

/// The flat strip, as a start.
StripAtRest level(const RowStrip& strip);

}  // namespace foldproof
