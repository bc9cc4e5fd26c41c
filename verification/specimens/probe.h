// Queries the forces of a scene from a subject; forces and their derivatives as matrices.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>

#include "reference/forces/force_differential.h"
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

/// The matrix of a linear map of 3 x N arrays, column by column: 3N x 3N, ordered by particle, like
/// all matrices here.
Eigen::MatrixXd matrix_of(Eigen::Index particles,
                          const std::function<PerParticle3(const PerParticle3&)>& map);
Eigen::MatrixXd matrix_of(const ForceDifferential& differential, Eigen::Index particles);

/// The damping matrix D at s [N s/m].
Eigen::MatrixXd damping_matrix(const Probe& probe, const State& s);

/// The reference's derivative of all forces by the positions, at fixed velocities [N/m].
Eigen::MatrixXd force_derivative(const Scene& scene, const State& s);

/// The derivative of forces by central differences of `step` [m]; and of the subject's forces at
/// fixed velocities, extrapolated from `step` and `step`/2 [N/m].
Eigen::MatrixXd central_differences(const std::function<PerParticle3(const State&)>& force,
                                    const State& s, double step);
Eigen::MatrixXd differences_of_forces(const Probe& probe, const State& s, double step);

/// The largest absolute entry of a matrix; NaN if any is.
double largest_entry(const Eigen::MatrixXd& matrix);

}  // namespace foldproof
