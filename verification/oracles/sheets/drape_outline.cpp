#include "verification/oracles/sheets/drape_outline.h"

#include <algorithm>
#include <cmath>

namespace foldproof::oracles {

namespace {

/// Extends the outline by an edge from a to a + d, in the directions that the edge covers.
void add_edge(Outline& outline, const Eigen::Vector2d& a, const Eigen::Vector2d& d) {
  const long directions = long(outline.size());
  const double step = 2 * pi / double(directions), from = std::atan2(a.y(), a.x());
  // the angle from a to a + d, to either side
  const double by = std::atan2(a.x() * d.y() - a.y() * d.x(), a.dot(a + d));
  const double low = std::min(from, from + by) / step, high = std::max(from, from + by) / step;
  for (long k = long(std::ceil(low)); k <= long(std::floor(high)); ++k) {
    const double c = std::cos(double(k) * step), s = std::sin(double(k) * step);
    const double across = d.x() * s - d.y() * c;
    if (across == 0) continue;
    // a + t d lies on the ray
    const double t = -(a.x() * s - a.y() * c) / across;
    double& reach = outline[std::size_t(((k % directions) + directions) % directions)];
    reach = std::max(reach, (a.x() + t * d.x()) * c + (a.y() + t * d.y()) * s);
  }
}

}  // namespace

Outline outline_of(const PerParticle3& x, const std::vector<std::array<int, 3>>& triangles,
                   double plate, int directions) {
  Outline outline(std::size_t(directions), plate);
  for (const std::array<int, 3>& triangle : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector2d a = x.col(triangle[k]).head<2>(),
                            b = x.col(triangle[(k + 1) % 3]).head<2>();
      add_edge(outline, a, b - a);
    }
  return outline;
}

double drape_coefficient(const Outline& outline, const DrapeRadii& radii) {
  double squares = 0;
  for (const double reach : outline) squares += reach * reach;
  const double plate = radii.plate * radii.plate;
  return (squares / double(outline.size()) - plate) / (radii.specimen * radii.specimen - plate);
}

int folds_of(const Outline& outline, double prominence) {
  // from the lowest point once around: up by the prominence, then down by it
  const std::size_t n = outline.size();
  const std::size_t first = std::size_t(std::ranges::min_element(outline) - outline.begin());
  double low = outline[first], high = low;
  bool rising = true;
  int folds = 0;
  for (std::size_t k = 1; k <= n; ++k) {
    const double reach = outline[(first + k) % n];
    if (rising) {
      high = std::max(high, reach);
      low = std::min(low, reach);
      if (high - low > prominence && reach < high - prominence) {
        ++folds;
        rising = false;
        low = reach;
      }
    } else {
      low = std::min(low, reach);
      if (reach > low + prominence) {
        rising = true;
        high = reach;
      }
    }
  }
  return folds;
}

}  // namespace foldproof::oracles
