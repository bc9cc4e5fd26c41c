#include "reference/post/depth_map.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "reference/types.h"

namespace foldproof {

namespace {

double plain(const DepthBand& band, double phi) { return std::max(phi, band.nearest); }

double power(const DepthBand& band, double phi) {
  if (phi >= band.reach) return phi;
  const double depths = band.reach + band.deepest, band_width = band.reach - band.nearest;
  const double u = std::max(0.0, (phi + band.deepest) / depths);
  return band.nearest + band_width * std::pow(u, depths / band_width);
}

//   f  |          /       room = tau - eps, depths = tau + t^: the image and the domain
//  tau |        _/        slope m on the first depths - w, then rising evenly to 1 over w:
//      |    _,-'            m (depths - w) + w (m + 1)/2 = room
//  eps |_,-'
//     -t^       tau  phi
double blend(const DepthBand& band, double phi) {
  if (phi >= band.reach) return phi;
  const double depths = band.reach + band.deepest, band_width = band.reach - band.nearest;
  const double w = band_width / 2, m = (band_width - w / 2) / (depths - w / 2);
  const double from_top = band.reach - phi;
  if (from_top < w) return phi + (1 - m) * from_top * from_top / (2 * w);
  return band.nearest + m * std::max(0.0, phi + band.deepest);
}

}  // namespace

const std::vector<DepthMap>& depth_maps() {
  static const std::vector<DepthMap> table = {
      {"plain", "plain projection", "what BMF03 section 5.3 warns of", plain},
      {"power", "power law", "BMF03 section 5.3; the form is ours", power},
      {"blend", "straight, then blended", "BMF03 section 5.3; the form is ours", blend}};
  return table;
}

const DepthMap& depth_map_named(std::string_view name) {
  std::string known;
  for (const DepthMap& map : depth_maps()) {
    if (map.name == name) return map;
    known += (known.empty() ? "" : ", ") + std::string(map.name);
  }
  throw InputError("unknown depth map '" + std::string(name) + "'; known: " + known);
}

void check_band(const DepthBand& band) {
  const bool is_sound = band.nearest >= 0 && band.nearest < band.reach && band.deepest >= 0 &&
                        std::isfinite(band.reach) && std::isfinite(band.deepest);
  if (!is_sound)
    throw InputError("a projection needs 0 <= eps < tau and 0 <= deepest, but eps = " +
                     std::to_string(band.nearest) + " m, tau = " + std::to_string(band.reach) +
                     " m, deepest = " + std::to_string(band.deepest) + " m");
}

}  // namespace foldproof
