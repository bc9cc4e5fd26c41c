// A strip that is held cylindrical: the vertices of each row across it move together, so that a
// mesh of triangles becomes a chain of rigid-width panels. What drives the rows are the subject's
// forces, summed over each row: by virtual work, those of the constrained strip.
#pragma once

#include <optional>
#include <vector>

#include "reference/mesh/shapes.h"
#include "verification/oracles/elastica.h"
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

/// How the last end is held: see StripHold.
enum class RowHold { clamped, pinned, propped };

/// How the strip is held: its first panel (rows 0 and 1) has a slope (upward positive [rad]); the
/// last one is free; or clamped: it has a slope too, and its middle is at a place from the first
/// one's middle [m]; or its last row is pinned to a place; or it is propped: pushed up in the
/// middle, just as hard as gives it a slope.
struct StripHold {
  struct End {
    double slope;           // of a clamp or a prop
    Eigen::Vector2d place;  // along and up; of no account for a prop
    RowHold hold = RowHold::clamped;
  };
  double slope = 0;
  std::optional<End> last;
};

/// The hinges of a held row stand for the curvature from half a cell before to half a cell behind
/// them, so that the strip is clamped in the middle of its held panels. There are `panels` more
/// than the first; L is `panels` spacings between two clamps, or a clamp and a prop, else
/// (panels + 1/2) spacings.
class RowStrip {
 public:
  RowStrip(const Subject& subject, const StripPattern& pattern, int panels, const StripLoad& load,
           const StripHold& hold);

  int panels() const { return panels_; }
  const StripHold& hold() const { return hold_; }
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
  StripHold hold_;
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
  Eigen::Vector2d hold_force = {0, 0};  // on a held last end, along and up [N]
};

/// For a strip with springs: Newton's method on slopes and lengths from a start, with a Jacobian by
/// central differences; force and moment that hold the last panel are unknowns, too. It ends when
/// steps no longer shrink; a strip not at rest after 40 has a last_step that says so.
StripAtRest at_rest(const RowStrip& strip, StripAtRest start);

/// The flat strip, as a start; at the slope of its first panel.
StripAtRest level(const RowStrip& strip);

}  // namespace foldproof
