#include "verification/specimens/probe.h"

#include "reference/dynamics/system.h"

namespace foldproof {

Probe::Probe(const Subject& subject, const Scene& scene)
    : subject_(subject), prepared_(require_offered(subject.prepare, "prepare")(scene)) {}

PerParticle3 Probe::elastic(const State& s) const {
  return require_offered(subject_.elastic_forces, "elastic_forces")(*prepared_, s);
}

PerParticle3 Probe::damping(const State& s, const PerParticle3& v) const {
  return require_offered(subject_.damping_forces, "damping_forces")(*prepared_, s, v);
}

double Probe::energy(const State& s) const {
  return require_offered(subject_.potential_energy, "potential_energy")(*prepared_, s);
}

Eigen::MatrixXd matrix_of(Eigen::Index particles,
                          const std::function<PerParticle3(const PerParticle3&)>& map) {
  Eigen::MatrixXd matrix(3 * particles, 3 * particles);
  for (Eigen::Index k = 0; k < matrix.cols(); ++k) {
    PerParticle3 unit = PerParticle3::Zero(3, particles);
    unit.reshaped()[k] = 1;
    const PerParticle3 column = map(unit);
    matrix.col(k) = column.reshaped();
  }
  return matrix;
}

Eigen::MatrixXd matrix_of(const ForceDifferential& differential, Eigen::Index particles) {
  return matrix_of(particles, [&](const PerParticle3& unit) {
    PerParticle3 product = PerParticle3::Zero(3, particles);
    differential.add_product(unit, product);
    return product;
  });
}

Eigen::MatrixXd damping_matrix(const Probe& probe, const State& s) {
  return matrix_of(s.x.cols(), [&](const PerParticle3& v) { return probe.damping(s, v); });
}

Eigen::MatrixXd force_derivative(const Scene& scene, const State& s) {
  const System system = build_system(scene);
  Work uncounted;
  return matrix_of(force_differential_at(system.forces, s, uncounted), s.x.cols());
}

Eigen::MatrixXd central_differences(const std::function<PerParticle3(const State&)>& force,
                                    const State& s, double step) {
  Eigen::MatrixXd K(s.x.size(), s.x.size());
  State moved = s;
  for (Eigen::Index k = 0; k < s.x.size(); ++k) {
    moved.x.reshaped()[k] = s.x.reshaped()[k] + step;
    const PerParticle3 ahead = force(moved);
    moved.x.reshaped()[k] = s.x.reshaped()[k] - step;
    const PerParticle3 column = (ahead - force(moved)) / (2 * step);
    moved.x.reshaped()[k] = s.x.reshaped()[k];
    K.col(k) = column.reshaped();
  }
  return K;
}

Eigen::MatrixXd differences_of_forces(const Probe& probe, const State& s, double step) {
  const auto force = [&](const State& at) -> PerParticle3 {
    return probe.elastic(at) + probe.damping(at, s.v);
  };
  const Eigen::MatrixXd coarse = central_differences(force, s, step),
                        fine = central_differences(force, s, step / 2);
  return (4 * fine - coarse) / 3;
}

double largest_entry(const Eigen::MatrixXd& matrix) {
  return matrix.cwiseAbs().maxCoeff<Eigen::PropagateNaN>();
}

}  // namespace foldproof
