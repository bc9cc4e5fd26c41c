// A heavy disc that hangs from its centre as a cone with folds: an elastica on a sphere.
#pragma once

#include <span>
#include <vector>

#include "verification/oracles/estimate.h"

namespace foldproof::oracles {

/// An inextensible disc hangs from its centre. Its radii stay straight: it is a cone over a closed
/// curve of length 2 pi on the unit sphere, by arc length s. With kappa the curve's curvature on
/// the sphere, the cone's is kappa/r. The energy over (bending rigidity times the logarithm of
/// outer over inner radius) is the integral of
///   kappa^2/2 + weight z,
/// with z the height of the point on the sphere over the centre. The minimum is sought among curves
/// of `folds` equal waves about the vertical, each its own mirror image, that do not overhang.
struct HungCone {
  Estimate energy;              // see above [1]
  Estimate depth;               // of the curve's mean height below the centre [1]
  std::vector<double> heights;  // z at the requested arc lengths, 0 at a crest
  double uncertainty = 0;       // of the heights
};

/// folds: 2 to 9; weight > 0. A weight that makes the folds overhang is refused.
/// By series: z = sum b_j cos(j folds s). Without overhang s gives the whole curve,
///   kappa = (z'' + z)/(1 - z^2 - z'^2)^(1/2),   azimuth' = (1 - z^2 - z'^2)^(1/2)/(1 - z^2),
/// and the energy is least under the azimuth of one wave. By shooting from a crest to a trough of
///   kappa'' + kappa^3/2 + kappa (1 - mu - weight z) + weight N_z = 0,
/// with N = point x tangent and mu the pull that keeps the length.
HungCone hung_cone_by_series(int folds, double weight, std::span<const double> arc_lengths);
HungCone hung_cone_by_shooting(int folds, double weight, std::span<const double> arc_lengths);

}  // namespace foldproof::oracles
