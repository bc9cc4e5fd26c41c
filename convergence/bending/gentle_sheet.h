// A flat sheet of any mesh, curved so gently that heights over the plane say all.
#pragma once

#include "reference/scene/scene.h"
#include "verification/specimens/measured.h"
#include "verification/oracles/definitions.h"
#include "verification/oracles/homogenised_bending.h"

namespace foldproof {

constexpr double gentle_side = 0.53;                     // of the sheets [m]
constexpr double gentle_curvature = 1e-3 / gentle_side;  // [1/m]
constexpr double gentle_bound =
    4e-6;  // the square of the largest slope, 1e-3 times the diagonal over the side,
           // twice [1]

/// Its bending energy at small curvature. Hinges near the border do not count; vertices near it are held when
/// the others settle.
class GentleSheet {
 public:
  /// width: of a cell [m].
  GentleSheet(const Subject& subject, TriangleMesh mesh, double width);

  /// D/ke of a cylinder curved along `angle` [rad] [1]: with all vertices on it, or with those inside where
  /// the subject's forces vanish.
  double forced(double angle) const;
  double relaxed(double angle) const;

  /// The same sheet in the oracle's words.
  const oracles::PlaneSheet& flat() const { return flat_; }

 private:
  Eigen::VectorXd cylinder(double angle) const;                // heights of all vertices [m]
  PerParticle3 raised(const Eigen::VectorXd& heights) const;   // 3 x N [m]
  double rigidity(const Eigen::VectorXd& heights) const;       // D/ke of the counted hinges [1]
  Eigen::VectorXd pull(const Eigen::VectorXd& heights) const;  // force across the sheet, 0 where held [N]

  const Subject& subject_;
  Scene scene_;
  Probe probe_;
  oracles::PlaneSheet flat_;
  double width_;     // of a cell [m]
  double area_ = 0;  // a third of the counted hinges' triangles [m^2]
};

}  // namespace foldproof
