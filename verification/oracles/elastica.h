#pragma once

#include <optional>
#include <span>
#include <vector>

namespace foldproof::oracles {

/// Support of the last end: slope and position held, or position alone.
enum class EndHold { clamped, pinned };

/// A held end: its slope, and its position relative to the first end. The slope of a pinned end is
/// an initial guess, which selects the branch.
struct StripEnd {
  double slope;       // of the direction along the strip, upward positive; whole turns count [rad]
  double across, up;  // over L [1]
  EndHold hold = EndHold::clamped;
};

/// An inextensible strip of length L, bent in a vertical plane by its weight and its ends (the
/// heavy elastica). With s the arc length over L and theta the slope above the horizontal,
///   theta'' = F_x sin(theta) - (F_y - gamma (1 - s)) cos(theta),   theta(0) = first_slope,
/// where (F_x, F_y) B/L^2 is the force that holds the last end. That end is clamped, pinned
/// (theta'(1) = 0), or free: then F = 0 and theta'(1) = 0.
struct HeavyStrip {
  double gamma;                  // rho_A g L^3/B >= 0 [1]
  double first_slope;            // rad
  std::optional<StripEnd> last;  // none: free
  // Selects one of several equilibria: the branch that starts, at gamma = 0, nearest to slopes that
  // change evenly from end to end, plus bulge sin(2 pi s) [rad].
  double bulge = 0;
};

struct StripPoint {
  double slope;       // rad
  double across, up;  // from the first end over L [1]
};

/// Points of a strip at the requested arc lengths.
struct StripShape {
  std::vector<StripPoint> points;
  double uncertainty;  // of any of their numbers
  // curvature at the first end [1/L], and the force that holds the last [B/L^2]
  double first_curvature = 0, force_across = 0, force_up = 0;
};

/// By collocation: theta is a polynomial through Chebyshev's nodes, and Newton's method solves
/// the equation at the nodes. 48 nodes and half as many again, until two answers agree to
/// 1e-11 or there are more than 300; the uncertainty is their difference and the rounding.
/// arc_lengths: over L, in [0, 1]. InputError for gamma not in [0, 1e5]; std::runtime_error if
/// there is no equilibrium.
StripShape strip_by_collocation(const HeavyStrip& strip, std::span<const double> arc_lengths);

/// A strip held at both ends, by shooting from the first with GSL's ODE solver; Newton's method
/// finds curvature and force there. It starts from the collocation result, which only selects the
/// branch. arc_lengths ascend. InputError for a free end.
StripShape strip_by_shooting(const HeavyStrip& strip, std::span<const double> arc_lengths);

}  // namespace foldproof::oracles
