#include "verification/specimens/probe.h"

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

Eigen::MatrixXd damping_matrix(const Probe& probe, const State& s) {
  const Eigen::Index size = s.x.size();
  Eigen::MatrixXd D(size, size);
  PerParticle3 v = PerParticle3::Zero(3, s.x.cols());
  for (Eigen::Index k = 0; k < size; ++k) {
    v.reshaped()[k] = 1;
    const PerParticle3 column = probe.damping(s, v);
    D.col(k) = column.reshaped();
    v.reshaped()[k] = 0;
  }
  return D;
}

}  // namespace foldproof
