#include "convergence/conjugate_gradients/cg_cost.h"

#include <cmath>
#include <random>

#include "reference/forces/bending.h"
#include "reference/mesh/shapes.h"
#include "verification/seeds.h"

namespace foldproof {

namespace {

constexpr int steps = 4;
constexpr double side = 0.9;        // m
constexpr double stiffness = 41;    // Y [N/m]
constexpr double bending = 2.3e-4;  // ke [J]

/// Waves and noise: every mode of the mesh takes part, so that no solve is easy by its start.
void set_motion(Scene& scene) {
  std::mt19937_64 generator(shifted_seed(914));
  const auto noise = [&generator] { return double(generator() >> 11) * 0x1p-53 - 0.5; };
  for (Eigen::Index i = 0; i < scene.x.cols(); ++i) {
    const double a = scene.mesh.rest(0, i) / side, b = scene.mesh.rest(1, i) / side;
    scene.x(2, i) += 0.06 * std::sin(5.3 * a + 1.7 * b);
    scene.v.col(i) = Vector3(0.3 * std::cos(2.9 * b) + 0.2 * noise(), 0.2 * noise(),
                             std::cos(4.7 * a - 2.2 * b) + 0.2 * noise());
  }
}

Scene elastic_sheet(int cells) {
  Scene scene =
      scene_at_rest(make_sheet({SheetPattern::alternating, side, side, cells, cells}), 0.15);
  scene.gravity = Vector3(0, -9.81, 0);
  scene.stretch = StretchMaterial{stiffness, 0, 1};
  scene.bending = BendingMaterial{bending, 0, Weighting::rest, DampingFactor::edge, "sine"};
  scene.rest_angles.assign(scene.mesh.hinges.size(), 0);
  set_motion(scene);
  for (int particle = cells * (cells + 1); particle < int(scene.x.cols()); ++particle)
    scene.prescribed.push_back({particle, scene.x.col(particle), {}});
  return scene;
}

/// Mean over the hinges of c/|E| at rest [1/m]: kd |E| is to ke c as kd is to ke times this.
double weight_over_edge(const TriangleMesh& mesh) {
  double sum = 0;
  for (const Hinge& hinge : mesh.hinges) {
    const auto [i1, i2, i3, i4] = hinge.particles;
    const HingeShape shape =
        hinge_shape(mesh.rest.col(i1), mesh.rest.col(i2), mesh.rest.col(i3), mesh.rest.col(i4));
    sum += shape.edge / shape.area_sum;
  }
  return sum / double(mesh.hinges.size());
}

/// The sheet with the damping that has the ratio, and its elastic limit [s].
///   zeta = (damping/stiffness) omega/2, which is kd_s/Y for springs and kd |E|/(ke c/2) for
///   hinges; omega is the bound on the fastest mode, 2 over the elastic limit
std::pair<Scene, double> damped_sheet(const Setting& setting) {
  Scene scene = elastic_sheet(setting.cells);
  const double limit = elastic_limit(build_system(scene), start_state(scene));
  const double omega = 2 / limit;
  scene.stretch->damping = stiffness * 2 * setting.ratio / omega;
  scene.bending->damping = bending / 2 * weight_over_edge(scene.mesh) * 2 * setting.ratio / omega;
  scene.solver = {setting.tolerance, 100'000, setting.scale};
  return {std::move(scene), limit};
}

}  // namespace

Cost cost_of(const Subject& subject, const Setting& setting) {
  auto [scene, limit] = damped_sheet(setting);
  Worst largest;
  Work all;
  for (const char* scheme : {"A", "B"}) {
    scene.integrator = scheme;
    const auto prepared = require_offered(subject.prepare, "prepare")(scene);
    State s = start_state(scene);
    for (int i = 0; i < steps; ++i) {
      Work one;
      s = require_offered(subject.step, "step")(*prepared, {&s, 1}, setting.step * limit, one);
      largest.observe(double(one.cg_iterations) / double(one.solves));
      all.cg_iterations += one.cg_iterations;
      all.solves += one.solves;
      all.unfinished_solves += one.unfinished_solves;
    }
  }
  return {double(all.cg_iterations) / double(all.solves), largest.value(),
          double(all.unfinished_solves)};
}

double iterations_allowed(const Setting& setting) {
  const double root = std::sqrt(1 + 2 * setting.ratio * setting.step);
  return std::ceil(std::log(2 * root / setting.tolerance) / std::log((root + 1) / (root - 1)));
}

double particles_of(const Setting& setting) {
  return double(setting.cells + 1) * (setting.cells + 1);
}

}  // namespace foldproof
