#include "convergence/validation/disc_of_sectors.h"

#include <algorithm>
#include <cmath>

#include "convergence/validation/drape_test.h"
#include "convergence/validation/equilibrium.h"
#include "verification/oracles/gsl.h"
#include "verification/oracles/sheets/hung_cone.h"
#include "verification/specimens/probe.h"
#include "verification/specimens/specimens.h"

namespace foldproof {

namespace {

constexpr double g = 9.80665;    // m/s^2
constexpr double radius = 0.17;  // m
constexpr double core = 0.2;     // of the radius that is one triangle a sector [1]
constexpr double ke = 2.3e-5;    // J

/// Particle 0 is the centre; those of a ring follow each other, from the innermost ring out. The
/// mesh is its own mirror image about two diameters, so that two folds lie still on it.
TriangleMesh mesh_of_sectors(int sectors) {
  const double angle = 2 * pi / sectors;
  const int rings = int(std::lround(std::log(1 / core) / std::log(1 + angle)));
  const auto at = [&](int ring, int spoke) { return 1 + ring * sectors + spoke % sectors; };
  PerParticle3 rest(3, at(rings, sectors - 1) + 1);
  rest.col(0).setZero();
  std::vector<Triangle> triangles;
  for (int ring = 0; ring <= rings; ++ring)
    for (int i = 0; i < sectors; ++i) {
      const double r = radius * std::pow(core, 1 - double(ring) / rings);
      rest.col(at(ring, i)) = r * Vector3(std::cos(angle * i), std::sin(angle * i), 0);
      if (ring == 0) {
        triangles.push_back({0, at(0, i), at(0, i + 1)});
        continue;
      }
      const int in = at(ring - 1, i), in_next = at(ring - 1, i + 1);
      const int out = at(ring, i), out_next = at(ring, i + 1);
      if (4 * i / sectors % 2 == 0) {
        triangles.push_back({in, out, out_next});
        triangles.push_back({in, out_next, in_next});
      } else {
        triangles.push_back({in, out, in_next});
        triangles.push_back({in_next, out, out_next});
      }
    }
  return make_triangle_mesh(std::move(rest), std::move(triangles));
}

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

/// Directions of the spokes on the unit sphere, neighbours apart by the angle of a sector.
std::vector<Vector3> spokes_of_cone(const HungDisc& disc) {
  const double angle = 2 * pi / disc.sectors;
  std::vector<double> arc_lengths;
  for (int i = 0; i < disc.sectors; ++i) arc_lengths.push_back(angle * i);
  std::vector<double> z =
      oracles::hung_cone_by_series(disc.folds, disc.weight, arc_lengths).heights;
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
  const double shift = oracles::bracketed_root(open, -0.02, 0.1, 0).value;
  const std::vector<double> azimuth = azimuths(shift);
  std::vector<Vector3> spokes;
  for (int i = 0; i < disc.sectors; ++i) {
    const double height = z[std::size_t(i)] + shift, level = std::sqrt(1 - height * height);
    spokes.push_back({level * std::cos(azimuth[std::size_t(i)]),
                      level * std::sin(azimuth[std::size_t(i)]), height});
  }
  return spokes;
}

/// The sheet without its density, gravity and start.
Scene sheet_of(const HungDisc& disc) {
  Scene scene = scene_at_rest(mesh_of_sectors(disc.sectors), 1);
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
  const std::vector<Vector3> spokes = spokes_of_cone(disc);
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

int folds_of(const DiscAtRest& rest) {
  Outline outline;
  for (const double height : rest.heights) outline.push_back(height * specimen_radius);
  return folds_of(outline);
}

}  // namespace foldproof
