// Maps of signed distance that move cloth out of an object and preserve the order of depths
// (BMF03 section 5.3).
#pragma once

#include <string_view>
#include <vector>

namespace foldproof {

/// The distances between which a map works.
struct DepthBand {
  double nearest;  // eps: distance outside at which the deepest points end up [m]
  double reach;    // tau: points farther out than this stay where they are [m]
  double deepest;  // t^: the deepest penetration that is still distinguished [m]
};

/// One row of the table of maps f: phi [m] -> the target signed distance [m]. All leave
/// phi >= tau unchanged.
struct DepthMap {
  std::string_view name, title, source;
  double (*at)(const DepthBand& band, double phi);
};

/// "plain":  f = max(phi, eps). Everything inside ends up flat on the surface.
/// "power":  f = eps + (tau - eps) u^p, u = (phi + t^)/(tau + t^), p = (tau + t^)/(tau - eps): f
///           and f' match the identity at tau. With t^ = 5 tau, p = 6: the deeper half of the
///           penetrations shares 0.5 % of the band.
/// "blend":  linear up to w = (tau - eps)/2 before tau; from there its slope rises evenly to 1,
///           reached at tau. No depth is compressed by more than
///           (tau + t^ - w/2)/(tau - eps - w/2), 7.7 where "power" compresses without limit.
/// The last two are eps for phi < -t^ and rise strictly from there to tau.
const std::vector<DepthMap>& depth_maps();

/// Throws InputError that lists the names.
const DepthMap& depth_map_named(std::string_view name);

/// Throws InputError unless 0 <= eps < tau and t^ >= 0, all finite.
void check_band(const DepthBand& band);

}  // namespace foldproof
