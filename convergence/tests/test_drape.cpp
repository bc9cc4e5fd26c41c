// The drape test's outline, coefficient and folds.
#include <catch2/catch.hpp>

#include "convergence/validation/drape_test.h"

using namespace foldproof;

TEST_CASE("the level ring has the whole area and no folds; a waved one what its wave gives") {
  const Scene scene = ring_of_cloth({drape_fabrics()[0], 20});
  const auto waved = [&](double height) {  // five waves, the higher the nearer to the edge
    PerParticle3 x = scene.mesh.rest;
    for (Eigen::Index i = 0; i < x.cols(); ++i) {
      const double radius = x.col(i).norm(), angle = std::atan2(x(1, i), x(0, i));
      const double part = (radius - plate_radius) / (specimen_radius - plate_radius);
      x.col(i) *= 1 + part * height * std::cos(5 * angle) / radius;
    }
    return oracles::outline_of(x, scene.mesh.triangles, plate_radius, 1440);
  };
  // a polygon of 276 corners
  CHECK(oracles::drape_coefficient(waved(0), drape_radii) == Approx(1).epsilon(0.002));
  CHECK(oracles::folds_of(waved(0), least_fold) == 0);
  const double more = 0.02 * 0.02 / 2 / (std::pow(specimen_radius, 2) - std::pow(plate_radius, 2));
  CHECK(oracles::drape_coefficient(waved(0.02), drape_radii) == Approx(1 + more).epsilon(0.003));
  CHECK(oracles::folds_of(waved(0.02), least_fold) == 5);
  CHECK(oracles::folds_of(waved(0.001), least_fold) == 0);
}

TEST_CASE("a fold that reaches further than the edge throws the shadow") {
  const Scene scene = ring_of_cloth({drape_fabrics()[0], 8});
  PerParticle3 x = scene.mesh.rest;
  for (Eigen::Index i = 0; i < x.cols(); ++i)
    if (x.col(i).norm() > 0.14) x.col(i) *= 0.1 / x.col(i).norm();  // turned under
  for (const double reach : oracles::outline_of(x, scene.mesh.triangles, plate_radius, 360))
    CHECK(reach > 0.13);
}
