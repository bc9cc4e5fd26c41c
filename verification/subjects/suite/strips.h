// A strip of equilateral triangles, and the rigidity that a solver gives it.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "verification/subjects/suite/trial.h"

namespace foldproof::suite {

/// Rows of edges along x, so many along y, about y = 0.
struct StripShape {
  int columns, rows;
  double edge;  // m

  double row_height() const;  // m
  double length() const;      // m
  double width() const;       // of a full row [m]
};

/// In its rest shape, without gravity; dt [s].
PortableScene free_strip(const StripShape& shape, const PortableMaterial& material, double dt);

/// Row of each particle, from 0 at the least y.
std::vector<int> rows_of(const PortableScene& strip, const StripShape& shape);

/// Mean places of the rows across the strip's width, of y and z [m].
Eigen::Matrix2Xd mean_rows(const PortableScene& strip, const StripShape& shape,
                           const PerParticle3& x);

/// Of (turn from panel to panel)^2 between such rows, summed [rad^2].
double squared_turns(const Eigen::Matrix2Xd& rows);

/// Particles of the rows at this distance from y = 0, in the rest shape.
std::vector<int> rows_at_distance(const PortableScene& strip, const StripShape& shape,
                                  double distance);

/// Measures a sheet where it is. In single precision, also in three other places `away` [m], and
/// returns the mean; throws NotOffered if their range is over twice `most` of it.
double beyond_rounding(Trial& trial, const char* of, double most,
                       const std::function<double(const Vector3& away)>& measured);

/// B as the law calibration.bending-rigidity-is-the-scene-s measures it, of this very strip [N m]:
/// let go from a cylinder, half of it gains angular momentum by the moment in its middle. Beyond
/// rounding, to `most` of it.
double measured_rigidity(Trial& trial, const PortableScene& strip, const StripShape& shape,
                         double most = 0.02);

/// GJ over the width, likewise [N m]: let go from an even twist [rad/m], half of the strip gains
/// angular momentum by the torque in its middle.
double measured_twisting(Trial& trial, const PortableScene& strip, const StripShape& shape,
                         double twist);

/// Throws FailedWithoutNumber if a measured rigidity, to "bending" or "twisting", is below a
/// hundredth of the scene's [N m]: such a strip would take too long to come to rest, or to fall.
void require_resistance(std::string_view to_what, double measured, double given);

struct Bracket {
  double stands, falls;  // gravity [m/s^2]; 0 if it falls under the least that is tried
  bool has_fallen = true;

  std::string stands_text() const;  // in words and units
  std::string falls_text() const;
};

/// The gravity under which a strip falls, by bisection: to a fiftieth of what is expected, in half
/// of it to one and a half times.
Bracket bracketed(double expected, const std::function<bool(double gravity)>& falls);

}  // namespace foldproof::suite
