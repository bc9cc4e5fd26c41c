#include "convergence/integrators/oracle_problem.h"

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <utility>

#include "verification/oracles/gsl.h"

namespace foldproof {

namespace {

using SortedPair = std::pair<int, int>;

double area_of(const PerParticle3& rest, const Triangle& triangle) {
  const Vector3 p = rest.col(triangle[0]), q = rest.col(triangle[1]), r = rest.col(triangle[2]);
  return (q - p).cross(r - p).norm() / 2;
}

/// Rest area at each edge: both triangles of an inner one.
std::map<SortedPair, double> areas_at_edges(const TriangleMesh& mesh) {
  std::map<SortedPair, double> areas;
  for (const Triangle& triangle : mesh.triangles)
    for (size_t k = 0; k < 3; ++k)
      areas[std::minmax({triangle[k], triangle[(k + 1) % 3]})] += area_of(mesh.rest, triangle);
  return areas;
}

void add_masses_and_springs(const Scene& scene, oracles::ClothDefinition& cloth) {
  const TriangleMesh& mesh = scene.mesh;
  cloth.masses.assign(size_t(mesh.rest.cols()), 0);
  for (const Triangle& triangle : mesh.triangles)
    for (int particle : triangle)
      cloth.masses[size_t(particle)] += scene.density * area_of(mesh.rest, triangle) / 3;
  for (const auto& [ends, area] : areas_at_edges(mesh)) {
    const double length = (mesh.rest.col(ends.second) - mesh.rest.col(ends.first)).norm();
    cloth.springs.push_back({ends.first, ends.second, length, area});
  }
}

void set_material(const Scene& scene, oracles::ClothMaterial& material) {
  if (scene.stretch) {
    if (scene.stretch->rest_length_scale != 1)
      throw InputError("oracle_of: scaled rest lengths are not known to the oracle");
    material.young = scene.stretch->stiffness;
    material.spring_damping = scene.stretch->damping;
  }
  if (!scene.bending) return;
  const BendingMaterial& bending = *scene.bending;
  if (bending.law != "sine")
    throw InputError("oracle_of: the oracle knows the bending law 'sine' only");
  material.bending_stiffness = bending.stiffness;
  material.bending_damping = bending.damping;
  material.elastic_geometry =
      bending.weighting == Weighting::rest ? oracles::Geometry::rest : oracles::Geometry::current;
  material.damping_factor = bending.damping_factor == DampingFactor::edge
                                ? oracles::DampingFactor::edge_length
                                : oracles::DampingFactor::anisotropy;
}

}  // namespace

oracles::Motion oracle_motion(const PrescribedParticle& prescribed) {
  const Motion& motion = prescribed.motion;
  if (motion.from != 0 || std::isfinite(motion.until))
    throw InputError("oracle_motion: particle " + std::to_string(prescribed.particle) +
                     " starts or stops on the way");
  if (!motion.velocity.isZero(0) || !motion.angular_velocity.isZero(0))
    throw InputError("oracle_motion: particle " + std::to_string(prescribed.particle) +
                     " turns or drifts; only oscillation is known");
  const Vector3 centre = prescribed.start - std::sin(motion.phase) * motion.amplitude;
  return oracles::harmonic_motion({centre, motion.amplitude, motion.frequency, motion.phase});
}

oracles::ClothDefinition oracle_of(const Scene& scene) {
  oracles::ClothDefinition cloth;
  add_masses_and_springs(scene, cloth);
  set_material(scene, cloth.material);
  if (scene.bending)
    for (size_t h = 0; h < scene.mesh.hinges.size(); ++h)
      cloth.hinges.push_back(oracles::hinge_at_rest(scene.mesh.hinges[h].particles, scene.mesh.rest,
                                                    scene.rest_angles[h]));
  if (scene.gravity) cloth.gravity = *scene.gravity;
  for (const PrescribedParticle& prescribed : scene.prescribed)
    cloth.prescribed[prescribed.particle] = oracle_motion(prescribed);
  return cloth;
}

ExactEnd exact_end(const Scene& scene, const oracles::ClothDefinition& cloth, double end,
                   double tolerance) {
  const std::vector<double> y0 = oracles::free_coordinates(cloth, {scene.x, scene.v});
  const std::array<double, 1> times = {end};
  const oracles::ReferenceSolution solution =
      oracles::reference_solution(oracles::cloth_rhs(cloth), y0, 0, times, tolerance);
  return {oracles::cloth_state(cloth, end, solution.values.front()), solution.uncertainty.front()};
}

}  // namespace foldproof
