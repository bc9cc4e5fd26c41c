// Quantities of a shell that stands or collapses: what is left of its height and of its
// angles at the end.
#include <cmath>

#include "verification/cases/quantities.h"

namespace foldproof {

namespace {

/// Against gravity, from the lowest particle to the highest [m].
double height_of(const Scene& scene, const PerParticle3& x) {
  const Vector3 up = -scene.gravity->normalized();
  const PerParticle heights = up.transpose() * x;
  return heights.maxCoeff() - heights.minCoeff();
}

double height_left(const RunView& run) {
  return height_of(run.scene, run.result.last.x) / height_of(run.scene, run.scene.x);
}

/// Root of the mean square over hinges [degrees].
double mean_turn(const RunView& run) {
  const std::vector<double> angles = hinge_angles(run.scene.mesh, run.result.last.x);
  double sum = 0;
  for (size_t h = 0; h < angles.size(); ++h) {
    const double turn = std::remainder(angles[h] - run.scene.rest_angles[h], 2 * pi);
    sum += turn * turn;
  }
  return std::sqrt(sum / double(angles.size())) * 180 / pi;
}

}  // namespace

std::vector<Quantity> standing_quantities() {
  return {
      {"keeps_its_height", "1",
       "At the end the cloth still has this share of its height at the start.", Sense::at_least,
       Scope::this_shape, nullptr, height_left, without_gravity},
      {"collapses_to", "1",
       "At the end the cloth has sunk to this share of its height at the start.", Sense::at_most,
       Scope::this_shape, nullptr, height_left, without_gravity},
      {"keeps_most_angles", "degrees",
       "At the end hinges are near their rest angles in the mean square.", Sense::at_most,
       Scope::this_shape, nullptr, mean_turn, without_bending},
      {"crumples_by", "degrees",
       "At the end hinges are far from their rest angles in the mean square.", Sense::at_least,
       Scope::this_shape, nullptr, mean_turn, without_bending},
  };
}

}  // namespace foldproof
