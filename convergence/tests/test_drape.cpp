// The drape test's outline, coefficient and folds, and where a sheet rests.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "convergence/validation/drape_test.h"
#include "convergence/validation/equilibrium.h"
#include "verification/specimens/probe.h"
#include "verification/specimens/specimens.h"
#include "verification/subjects/reference_subject.h"

using namespace foldproof;

namespace {

/// Moves each vertex from the axis by a wave, the more the nearer it is to the edge.
PerParticle3 waved(const TriangleMesh& mesh, int folds, double height) {
  PerParticle3 x = mesh.rest;
  for (Eigen::Index i = 0; i < x.cols(); ++i) {
    const double radius = x.col(i).norm(), angle = std::atan2(x(1, i), x(0, i));
    const double part = (radius - plate_radius) / (specimen_radius - plate_radius);
    x.col(i) *= 1 + part * height * std::cos(folds * angle) / radius;
  }
  return x;
}

oracles::Outline drape_outline(const PerParticle3& x, const Scene& scene) {
  return oracles::outline_of(x, scene.mesh.triangles, plate_radius, 1440);
}

}  // namespace

TEST_CASE("the level ring has the whole area and no folds; a waved one what its wave gives") {
  const Scene scene = ring_of_cloth({drape_fabrics()[0], 20});
  const oracles::Outline level = drape_outline(scene.mesh.rest, scene);
  // a polygon of 276 corners
  CHECK(oracles::drape_coefficient(level, drape_radii) == Approx(1).epsilon(0.002));
  CHECK(oracles::folds_of(level, least_fold) == 0);

  const double height = 0.02;
  const oracles::Outline wave = drape_outline(waved(scene.mesh, 5, height), scene);
  const double more =
      height * height / 2 / (specimen_radius * specimen_radius - plate_radius * plate_radius);
  CHECK(oracles::drape_coefficient(wave, drape_radii) == Approx(1 + more).epsilon(0.003));
  CHECK(oracles::folds_of(wave, least_fold) == 5);
  CHECK(oracles::folds_of(drape_outline(waved(scene.mesh, 5, 0.001), scene), least_fold) == 0);
}

TEST_CASE("a fold that reaches further than the edge throws the shadow") {
  const Scene scene = ring_of_cloth({drape_fabrics()[0], 8});
  PerParticle3 x = scene.mesh.rest;
  for (Eigen::Index i = 0; i < x.cols(); ++i) {
    const double radius = x.col(i).norm();
    if (radius > 0.14) x.col(i) *= 0.1 / radius;  // turned under
  }
  for (const double reach : oracles::outline_of(x, scene.mesh.triangles, plate_radius, 360))
    CHECK(reach > 0.13);
}

TEST_CASE("the drape test's fabrics are those of the shipped file, by the mean of two rigidities") {
  const std::vector<Fabric> fabrics = read_fabrics(CASES_FOLDER "/fabrics.toml");
  CHECK(drape_fabrics().size() == fabrics.size());
  for (const DrapeFabric& fabric : drape_fabrics()) {
    const Fabric& read = fabric_named(fabrics, fabric.name, "here");
    CHECK(fabric.density == Approx(read.density).epsilon(1e-9));
    CHECK(fabric.rigidity == Approx((read.rigidity[0] + read.rigidity[1]) / 2).epsilon(1e-6));
  }
  const DrapeFabric& wool = drape_fabrics()[0];
  CHECK(bending_length(wool) == Approx(0.01475).epsilon(0.001));
  CHECK(weight_for(wool.rigidity, bending_length(wool)) == Approx(wool.density));
}

TEST_CASE("a drape is where the subject's forces vanish, and a push raises its energy") {
  const Scene scene = ring_of_cloth({drape_fabrics()[0], 4});
  const Equilibrium rest = equilibrium_of(reference_subject(), scene);
  CHECK(rest.unbalanced < 1e-8);
  CHECK(rest.stable);
  const Probe probe(reference_subject(), scene);
  const double energy = probe.energy(resting_state(rest.x));
  PerParticle3 pushed = rest.x;
  for (const double side : {-1.0, 1.0}) {
    pushed(2, pushed.cols() - 1) = rest.x(2, rest.x.cols() - 1) + side * 1e-4;
    CHECK(probe.energy(resting_state(pushed)) > energy);
  }
}
