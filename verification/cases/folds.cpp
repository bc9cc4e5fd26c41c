#include "verification/cases/folds.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "reference/forces/bending.h"

namespace foldproof {

FoldSpectrum fold_spectrum(const TriangleMesh& mesh, const PerParticle3& x) {
  const std::vector<double> angles = hinge_angles(mesh, x);
  const Eigen::VectorXd lengths = rest_lengths(mesh);
  FoldSpectrum shares = {};
  double sum = 0;  // of lengths [m]
  for (size_t h = 0; h < angles.size(); ++h) {
    const double angle = std::abs(angles[h]) * 180 / pi, length = lengths[mesh.hinges[h].edge];
    if (std::isnan(angle)) {
      shares.fill(std::numeric_limits<double>::quiet_NaN());
      return shares;
    }
    const auto end = std::ranges::upper_bound(fold_band_ends, angle);
    shares[size_t(end - fold_band_ends.begin())] += length;
    sum += length;
  }
  if (sum > 0)
    for (double& share : shares) share /= sum;
  return shares;
}

std::string name_of_fold_band(size_t band) {
  const double from = band == 0 ? 0 : fold_band_ends[band - 1];
  const double to = band < fold_band_ends.size() ? fold_band_ends[band] : 180;
  return fmt::format("{:g} to {:g} degrees", from, to);
}

}  // namespace foldproof
