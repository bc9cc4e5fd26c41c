#include "convergence/stable_step.h"

#include <cmath>
#include <limits>
#include <random>

namespace foldproof {

namespace {

/// Does a small disturbance stay small in steps of h [s]? Stable motion is bounded by the modes' amplitudes,
/// unstable motion grows beyond every bound.
enum class Fate { stays, grows };

struct Trial {
  const Subject& subject;
  const Scene& scene;
  Prepared& prepared;
  int steps;
};

Fate fate_of(const Trial& trial, double h) {
  constexpr double growth = 1000;
  State s = start_state(trial.scene);
  s.x += small_disturbance * disturbance_shape(s.x.cols());
  const double start = (s.x - trial.scene.x).norm();
  Work uncounted;
  for (int i = 0; i < trial.steps; ++i) {
    s = trial.subject.step(trial.prepared, {&s, 1}, h, uncounted);
    if (!((s.x - trial.scene.x).norm() <= growth * start)) return Fate::grows;
  }
  return Fate::stays;
}

}  // namespace

PerParticle3 disturbance_shape(Eigen::Index n) {
  std::mt19937_64 generator(6021);
  PerParticle3 values(3, n);
  for (Eigen::Index i = 0; i < values.size(); ++i)
    values.data()[i] = double(generator() >> 11) * 0x1p-53 - 0.5;
  return values;
}

FastestMode fastest_mode(const Subject& subject, const Scene& scene) {
  constexpr int rounds = 400;
  const auto prepared = offered(subject.prepare, "prepare")(scene);
  const auto& forces = offered(subject.elastic_forces, "elastic_forces");
  const PerParticle root = lumped_masses(scene.mesh, scene.density).cwiseSqrt().cwiseInverse();
  State s = start_state(scene);
  FastestMode fastest{0, {}};
  PerParticle3 mode = disturbance_shape(s.x.cols()).normalized();
  for (int i = 0; i < rounds; ++i) {
    PerParticle3 shift = mode * root.asDiagonal();
    shift *= small_disturbance / shift.norm();
    s.x = scene.x + shift;
    const PerParticle3 ahead = forces(*prepared, s);
    s.x = scene.x - shift;
    const PerParticle3 behind = forces(*prepared, s);
    const PerParticle3 unit = shift * root.cwiseInverse().asDiagonal();
    const PerParticle3 product = (behind - ahead) / 2 * root.asDiagonal();
    fastest.omega = std::sqrt(product.cwiseProduct(unit).sum() / unit.squaredNorm());
    fastest.shape = shift.normalized();
    mode = product.normalized();
  }
  return fastest;
}

double largest_stable_step(const Subject& subject, const Scene& scene, double omega,
                           const StepSearch& search) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const auto prepared = offered(subject.prepare, "prepare")(scene);
  offered(subject.step, "step");
  const Trial trial{subject, scene, *prepared, search.steps};
  double below = search.low, above = search.high;
  if (fate_of(trial, below * 2 / omega) == Fate::grows) return nan;
  if (fate_of(trial, above * 2 / omega) == Fate::stays) return nan;
  for (int i = 0; i < search.halvings; ++i) {
    const double middle = (below + above) / 2;
    (fate_of(trial, middle * 2 / omega) == Fate::stays ? below : above) = middle;
  }
  return (below + above) / 2;
}

}  // namespace foldproof
