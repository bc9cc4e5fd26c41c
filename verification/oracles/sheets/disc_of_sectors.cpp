#include "verification/oracles/sheets/disc_of_sectors.h"

#include <algorithm>
#include <cmath>

#include "verification/oracles/gsl.h"
#include "verification/oracles/sheets/hung_cone.h"

namespace foldproof::oracles {

int DiscOfSectors::rings() const {
  return int(std::lround(std::log(1 / core) / std::log(1 + 2 * pi / sectors)));
}

int DiscOfSectors::particle(int ring, int spoke) const {
  return 1 + ring * sectors + spoke % sectors;
}

PerParticle3 DiscOfSectors::rest() const {
  PerParticle3 rest(3, particle(rings(), sectors - 1) + 1);
  rest.col(0).setZero();
  for (int ring = 0; ring <= rings(); ++ring)
    for (int i = 0; i < sectors; ++i) {
      const double r = radius * std::pow(core, 1 - double(ring) / rings());
      const double angle = 2 * pi / sectors * i;
      rest.col(particle(ring, i)) = r * Vector3(std::cos(angle), std::sin(angle), 0);
    }
  return rest;
}

std::vector<std::array<int, 3>> DiscOfSectors::triangles() const {
  std::vector<std::array<int, 3>> all;
  for (int i = 0; i < sectors; ++i) all.push_back({0, particle(0, i), particle(0, i + 1)});
  for (int ring = 1; ring <= rings(); ++ring)
    for (int i = 0; i < sectors; ++i) {
      const int in = particle(ring - 1, i), in_next = particle(ring - 1, i + 1);
      const int out = particle(ring, i), out_next = particle(ring, i + 1);
      if (4 * i / sectors % 2 == 0) {
        all.push_back({in, out, out_next});
        all.push_back({in, out_next, in_next});
      } else {
        all.push_back({in, out, in_next});
        all.push_back({in_next, out, out_next});
      }
    }
  return all;
}

std::vector<Vector3> spokes_of_hung_cone(int folds, double weight, int sectors) {
  const double angle = 2 * pi / sectors;
  std::vector<double> arc_lengths;
  for (int i = 0; i < sectors; ++i) arc_lengths.push_back(angle * i);
  std::vector<double> z = hung_cone_by_series(folds, weight, arc_lengths).heights;
  z.push_back(z.front());
  const auto azimuths = [&](double shift) {
    std::vector<double> all{0};
    for (std::size_t i = 1; i < z.size(); ++i) {
      const double a = z[i - 1] + shift, b = z[i] + shift;
      const double level = (std::cos(angle) - a * b) / std::sqrt((1 - a * a) * (1 - b * b));
      all.push_back(all.back() + std::acos(std::clamp(level, -1.0, 1.0)));
    }
    return all;
  };
  // a polygon of these heights turns by less than a full turn; higher up its circle is longer
  const auto open = [&](double shift) { return azimuths(shift).back() - 2 * pi; };
  const double shift = bracketed_root(open, -0.02, 0.1, 0).value;
  const std::vector<double> azimuth = azimuths(shift);
  std::vector<Vector3> spokes;
  for (int i = 0; i < sectors; ++i) {
    const double height = z[std::size_t(i)] + shift, level = std::sqrt(1 - height * height);
    spokes.push_back({level * std::cos(azimuth[std::size_t(i)]),
                      level * std::sin(azimuth[std::size_t(i)]), height});
  }
  return spokes;
}

}  // namespace foldproof::oracles
