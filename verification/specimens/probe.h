// Queries the forces of a scene from a subject.
#pragma once

#include <Eigen/Core>
#include <memory>

#include "verification/subject.h"

namespace foldproof {

/// A scene prepared by a subject. Each call throws NotOffered if the subject has no such operation.
class Probe {
 public:
  Probe(const Subject& subject, const Scene& scene);

  PerParticle3 elastic(const State& s) const;                         // 3 x N [N]
  PerParticle3 damping(const State& s, const PerParticle3& v) const;  // 3 x N [N]
  double energy(const State& s) const;                                // J

 private:
  const Subject& subject_;
  std::unique_ptr<PreparedScene> prepared_;
};

/// The damping matrix D at s, column by column: 3N x 3N [N s/m], coordinates particle by particle.
Eigen::MatrixXd damping_matrix(const Probe& probe, const State& s);

}  // namespace foldproof
