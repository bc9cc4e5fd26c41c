#include "convergence/stability/stable_step.h"

#include <cmath>

#include "reference/mesh/shapes.h"
#include "verification/specimens/stepper.h"
#include "verification/specimens/random.h"

namespace foldproof {

namespace {

/// Does a small disturbance stay small in steps of h [s]? Stable motion is bounded by the modes'
/// amplitudes, unstable motion grows beyond every bound.
bool stays(Stepper& stepper, int steps, double h) {
  constexpr double growth = 1000;
  const Scene& scene = stepper.scene();
  State s = stepper.start();
  s.x += small_disturbance * disturbance_shape(s.x.cols());
  const double start = (s.x - scene.x).norm();
  for (int i = 0; i < steps; ++i) {
    s = stepper.step(s, h);
    if (!((s.x - scene.x).norm() <= growth * start)) return false;
  }
  return true;
}

}  // namespace

PerParticle3 disturbance_shape(Eigen::Index n) { return Random(6021).vectors(n, 0.5); }

Scene flat_sheet(int cells) {
  Scene scene = scene_at_rest(
      make_sheet({SheetPattern::union_jack, flat_side, flat_side, cells, cells}), 0.23);
  scene.rest_angles.assign(scene.mesh.hinges.size(), 0);
  return scene;
}

ForceOperator elastic_operator(const Subject& subject, const Scene& scene) {
  const std::shared_ptr<PreparedScene> prepared =
      require_offered(subject.prepare, "prepare")(scene);
  const auto& forces = require_offered(subject.elastic_forces, "elastic_forces");
  return [&forces, prepared, start = start_state(scene)](const PerParticle3& displacement) {
    const double scale = small_disturbance / displacement.norm();
    State ahead = start, behind = start;
    ahead.x += scale * displacement;
    behind.x -= scale * displacement;
    return PerParticle3((forces(*prepared, ahead) - forces(*prepared, behind)) / (2 * scale));
  };
}

ForceOperator damping_operator(const Subject& subject, const Scene& scene) {
  const std::shared_ptr<PreparedScene> prepared =
      require_offered(subject.prepare, "prepare")(scene);
  const auto& forces = require_offered(subject.damping_forces, "damping_forces");
  return [&forces, prepared, start = start_state(scene)](const PerParticle3& v) {
    return forces(*prepared, start, v);
  };
}

LargestEigenvalue largest_eigenvalue(const Scene& scene, const ForceOperator& F) {
  constexpr int rounds = 400;
  PerParticle root = lumped_masses(scene.mesh, scene.density).cwiseSqrt().cwiseInverse();
  for (const PrescribedParticle& prescribed : scene.prescribed) root[prescribed.particle] = 0;
  PerParticle3 mode = (disturbance_shape(scene.x.cols()) * root.asDiagonal()).normalized();
  LargestEigenvalue largest{0, {}};
  for (int i = 0; i < rounds; ++i) {
    const PerParticle3 displacement = mode * root.asDiagonal();
    const PerParticle3 product = -F(displacement) * root.asDiagonal();
    largest.value = product.cwiseProduct(mode).sum();
    largest.shape = displacement.normalized();
    mode = product.normalized();
  }
  return largest;
}

FastestMode fastest_mode(const Subject& subject, const Scene& scene) {
  const LargestEigenvalue largest = largest_eigenvalue(scene, elastic_operator(subject, scene));
  return {std::sqrt(largest.value), largest.shape};
}

double largest_stable_step(const Subject& subject, const Scene& scene, double omega,
                           const StepSearch& search) {
  Stepper stepper(subject, scene, scene.integrator);
  const auto is_stable = [&](double step) {
    return stays(stepper, search.steps, step * 2 / omega);
  };
  double below = search.low, above = search.high;
  if (!is_stable(below) || is_stable(above)) return nan;
  for (int i = 0; i < search.halvings; ++i) {
    const double middle = (below + above) / 2;
    (is_stable(middle) ? below : above) = middle;
  }
  return (below + above) / 2;
}

}  // namespace foldproof
