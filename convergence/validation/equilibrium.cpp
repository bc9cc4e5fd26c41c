#include "convergence/validation/equilibrium.h"

#include "convergence/validation/freedoms.h"

namespace foldproof {

Equilibrium equilibrium_of(const Subject& subject, const Scene& scene) {
  const Probe probe(subject, scene);
  const Freedoms freedoms = free_particles(scene);
  const Hessian hessian(scene, freedoms);
  const Eigen::VectorXd masses =
      freedoms.gather(lumped_masses(scene.mesh, scene.density).transpose().replicate(3, 1));
  const Settled settled = settle({probe, hessian, freedoms, Eigen::VectorXd::Zero(freedoms.count),
                                  masses * scene.gravity.value().norm(), 1e-8,
                                  2 * smallest_height(scene.mesh.triangles, scene.mesh.rest)},
                                 scene.x);
  // a millionth of how strongly gravity holds a pendulum as long as the sheet
  const double extent = scene.mesh.rest.colwise().norm().maxCoeff();
  const double pendulum = scene.gravity.value().norm() / extent;  // 1/s^2
  const SparseFactors factors(hessian.at(settled.x, Definiteness::exact, 1e-6 * pendulum));
  return {settled.x, settled.unbalanced, settled.steps, positive_pivots(factors)};
}

}  // namespace foldproof
