#include "convergence/validation/disc_of_sectors.h"

#include <algorithm>
#include <cmath>

#include "convergence/validation/equilibrium.h"
#include "verification/oracles/sheets/disc_of_sectors.h"
#include "verification/oracles/sheets/drape_outline.h"
#include "verification/specimens/probe.h"
#include "verification/specimens/specimens.h"

namespace foldproof {

namespace {

constexpr double g = 9.80665;    // m/s^2
constexpr double radius = 0.17;  // m
constexpr double core = 0.2;     // of the radius that is one triangle a sector [1]
constexpr double ke = 2.3e-5;    // J

oracles::DiscOfSectors disc_of(const HungDisc& disc) { return {disc.sectors, radius, core}; }

/// Sum of l/(h1 + h2) over the hinges of one spoke, in the mean [1].
double hinges_of_a_spoke(const TriangleMesh& mesh, int sectors) {
  double sum = 0;
  for (const Hinge& hinge : mesh.hinges) {
    const Vector3 from = mesh.rest.col(hinge.particles[2]), to = mesh.rest.col(hinge.particles[3]);
    if (from.cross(to).norm() > 1e-9 * radius * radius) continue;  // not along a radius
    const Vector3 along = to - from;
    const auto twice_area = [&](int corner) {
      return along.cross(mesh.rest.col(hinge.particles[std::size_t(corner)]) - from).norm();
    };
    sum += along.squaredNorm() / (twice_area(0) + twice_area(1));
  }
  return sum / sectors;
}

/// The sheet without its density, gravity and start.
Scene sheet_of(const HungDisc& disc) {
  Scene scene =
      scene_at_rest(make_triangle_mesh(disc_of(disc).rest(), disc_of(disc).triangles()), 1);
  scene.bending = BendingMaterial{ke, 0, Weighting::rest, DampingFactor::edge, "sine"};
  scene.rest_angles.assign(scene.mesh.hinges.size(), 0);
  scene.prescribed.push_back({0, Vector3::Zero(), Motion{}});
  return scene;
}

/// Energy of forces alone: stretch and bending.
double elastic_energy(const Subject& subject, Scene scene, const PerParticle3& x) {
  scene.gravity.reset();
  return Probe(subject, scene).energy(resting_state(x));
}

}  // namespace

DiscAtRest disc_at_rest(const Subject& subject, const HungDisc& disc) {
  Scene scene = sheet_of(disc);
  const TriangleMesh& mesh = scene.mesh;
  // bending of a cone: unit times the integral of kappa^2/2, as the sum of theta = angle kappa
  const double unit = ke * pi / disc.sectors * hinges_of_a_spoke(mesh, disc.sectors);
  const PerParticle areas = lumped_masses(mesh, 1);
  const double moment = areas.dot(mesh.rest.colwise().norm().transpose());  // m^3
  scene.density = disc.weight * 2 * pi * unit / (g * moment);
  scene.gravity = Vector3(0, 0, -g);
  scene.stretch = StretchMaterial{disc.stretch * scene.density * g * radius, 0, 1};
  const std::vector<Vector3> spokes =
      oracles::spokes_of_hung_cone(disc.folds, disc.weight, disc.sectors);
  for (int i = 1; i < mesh.particles(); ++i)
    scene.x.col(i) = mesh.rest.col(i).norm() * spokes[std::size_t((i - 1) % disc.sectors)];

  const Equilibrium rest = equilibrium_of(subject, scene);
  DiscAtRest result;
  const double potential = scene.density * g * areas.dot(rest.x.row(2).transpose());
  const double elastic = elastic_energy(subject, scene, rest.x);
  result.energy = (potential + elastic) / unit;
  result.depth = -potential / (2 * pi * unit * disc.weight);
  for (int i = 0; i < disc.sectors; ++i)
    result.heights.push_back(rest.x(2, mesh.particles() - disc.sectors + i) / radius);
  result.unbalanced = rest.unbalanced;
  result.stable = rest.stable;
  scene.stretch.reset();
  const double bending = elastic_energy(subject, scene, rest.x);
  result.stretch_share = (elastic - bending) / bending;
  return result;
}

int folds_of(const DiscAtRest& rest) { return oracles::folds_of(rest.heights, 0.02); }

}  // namespace foldproof
