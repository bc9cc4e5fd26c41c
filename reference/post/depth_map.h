// Maps of signed distance that bring cloth out of an object and keep the order of its depths
// (BMF03 section 5.3).
#pragma once

#include <string_view>
#include <vector>

namespace foldproof {

/// The distances between which a map works.
struct DepthBand {
  double nearest;  // eps: how far out the deepest points come to lie [m]
  double reach;    // tau: points farther out than this stay where they are [m]
  double deepest;  // t^: the deepest penetration that is told from deeper ones [m]
};

/// One row of the table of maps f: phi [m] -> the signed distance to be reached [m]. All leave
/// phi >= tau alone.
struct DepthMap {
  std::string_view name, title, source;
  double (*at)(const DepthBand& band, double phi);
};

/// "plain":  f = max(phi, eps). What was inside comes to lie flat on the surface.
/// "power":  f = eps + (tau - eps) u^p, u = (phi + t^)/(tau + t^), p = (tau + t^)/(tau - eps): f
///           and f' are those of phi at tau. With t^ = 5 tau, p = 6: the deeper half of the
///           penetrations shares .5 % of the band.
/// "blend":  linear up to w = (tau - eps)/2 before tau; from there its slope rises evenly to 1,
///           reached at tau. No depth is pressed together by more than
///           (tau + t^ - w/2)/(tau - eps - w/2), 7.7 where "power" presses without limit.
/// The last two are eps for phi < -t^ and rise strictly from there to tau.
const std::vector<DepthMap>& depth_maps();

/// Throws InputError that lists the names.
const DepthMap& depth_map_named(std::string_view name);

/// Throws InputError unless 0 <= eps < tau and t^ >= 0, all finite.
void check_band(const DepthBand& band);

}  // namespace foldproof
