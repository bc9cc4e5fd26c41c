// Hanging chains, and the weights at which a ribbon on edge and a column buckle.
#pragma once

#include <span>
#include <vector>

#include "verification/oracles/estimate.h"

namespace foldproof::oracles {

/// A ribbon that is clamped at one end with its width upright, loaded by its weight, tips sideways
/// at q L^3/sqrt(EI GJ) = this; EI is that of bending out of its plane, and q its weight per
/// length. With t the distance from the free end over L and Q that load, its twist obeys
///   phi'' + (Q^2/4) t^4 phi = 0,   phi'(0) = 0,   phi(1) = 0,
/// since the weight beyond t bends by q t^2/2 in the stiff plane. Narrow: no warping at the clamp.
/// By the power series of phi in extended precision; by GSL's ODE solver.
Estimate tipping_load_by_series();
Estimate tipping_load_by_shooting();

/// phi of the ribbon at that load, over its value at the free end.
double tipping_twist(double t);

/// A column that is clamped at its foot falls under its own weight at q L^3/(EI) = this, q its
/// weight per length (Greenhill). With t the distance from the free end over L and G that load,
/// its slope obeys
///   phi'' + G t phi = 0,   phi'(0) = 0,   phi(1) = 0.
/// By the power series of phi in extended precision; by GSL's ODE solver.
Estimate self_buckling_load_by_series();
Estimate self_buckling_load_by_shooting();

/// phi of the column at that load, over the distance of its free end from the vertical over L.
double self_buckling_slope(double t);

/// The frequency of the n-th mode, n = 1..5, of a chain of length L hanging from one end, over
/// sqrt(g/L): half the n-th root of Bessel's J0. By its power series in extended precision; by
/// GSL's solution of Bessel's equation.
Estimate chain_frequency_by_series(int n);
Estimate chain_frequency_by_shooting(int n);

/// A chain of length 1 hangs between two points; the second is `across` and `up` from the first.
struct HungChain {
  double across, up;  // over L; their distance is below 1
};

struct CatenaryPoint {
  double across, up;  // from the first end over L
};

struct Catenary {
  std::vector<CatenaryPoint> points;  // at the requested arc lengths
  Estimate pull_across, pull_up;      // by the first end on its support, over the weight; up: < 0
  double uncertainty = 0;             // of the points
};

/// By hyperbolic functions, with GSL's root for the parameter.
Catenary catenary(const HungChain& chain, std::span<const double> arc_lengths);

/// By integrating the balance of forces, x' = H/T, y' = (s - V)/T, T^2 = H^2 + (s - V)^2, with
/// GSL's ODE solver; the pulls H and V by Newton's method. arc_lengths ascend.
Catenary catenary_by_shooting(const HungChain& chain, std::span<const double> arc_lengths);

}  // namespace foldproof::oracles
