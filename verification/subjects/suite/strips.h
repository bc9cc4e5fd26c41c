// A strip of equilateral triangles, and the rigidity that a solver gives it.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "verification/subjects/suite/scenes.h"

namespace foldproof::suite {

// A wide strip has the plate's rigidity B. A narrow one, whose sides curl the other way, has the
// beam's, B (1 - nu^2); others are between them.
constexpr double largest_poisson = 0.5;  // nu [1]
constexpr double least_rigidity = 1e-2;  // of the scene's: limper strips hang as a chain [1]

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

/// The strip with its rows there, across and up [m]; two rows at each end are held.
PortableScene clamped_strip(const PortableScene& strip, const StripShape& shape,
                            const Eigen::Matrix2Xd& rows, double gravity);

/// Of (turn from panel to panel)^2 between such rows, summed [rad^2].
double squared_turns(const Eigen::Matrix2Xd& rows);

/// Particles of the rows at this distance from y = 0, in the rest shape.
std::vector<int> rows_at_distance(const PortableScene& strip, const StripShape& shape,
                                  double distance);

/// The gravity under which rho g L^3/B is gamma [m/s^2].
double gravity_of(double gamma, double rigidity, const PortableScene& strip, double length);

/// Weights between which a strip is, over that of its rigidity: it is measured to 2 % and to
/// `rounding` of the load, and the strip may be a plate or a beam [1].
std::array<double, 2> possible_weights(double rounding);

/// Of a clamped strip's slowest vibration [rad/s].
double slowest_vibration(double rigidity, const PortableScene& strip, double length);

/// Bends a flat sheet to a cylinder, along an axis of its plane [1/m].
void bend(PortableScene& sheet, int axis, double curvature);

/// Of the part whose rest shape is beyond `from` along that axis, about the other one; `away` is
/// where the sheet lies [kg m^2/s].
double angular_momentum(const PortableScene& sheet, const PerParticle3& v, int axis, double from,
                        const Vector3& away);

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
