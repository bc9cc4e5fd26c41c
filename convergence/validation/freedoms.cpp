#include "convergence/validation/freedoms.h"

#include "reference/mesh/shapes.h"
#include "verification/oracles/homogenised_bending.h"
#include "verification/specimens/specimens.h"

namespace foldproof {

Settled settle(const SheetSettling& settling, PerParticle3 x) {
  const auto push = [&](const PerParticle3& at) {
    const Eigen::VectorXd force =
        settling.freedoms.gather(settling.probe.elastic(resting_state(at))) + settling.load;
    return Push{force, force.cwiseQuotient(settling.scale).cwiseAbs().maxCoeff()};
  };
  const auto stiffness = [&](const PerParticle3& at, Definiteness definiteness, double mass_over) {
    return settling.hessian.at(resting_state(at), definiteness, mass_over);
  };
  const auto moved = [&](const PerParticle3& at, const Eigen::VectorXd& by) {
    return settling.freedoms.moved(at, by);
  };
  return settle(Settling{push, stiffness, moved, {}, {}, settling.tolerance, settling.longest},
                std::move(x));
}

Equilibrium equilibrium_of(const Subject& subject, const Scene& scene) {
  const Probe probe(subject, scene);
  const System system = build_system(scene);
  const Freedoms freedoms = freedoms_of(system);
  const Hessian hessian(system, freedoms);
  const Eigen::VectorXd masses = freedoms.gather(system.mass.transpose().replicate(3, 1));
  const Settled settled =
      settle(SheetSettling{probe, hessian, freedoms, Eigen::VectorXd::Zero(freedoms.count),
                           masses * scene.gravity.value().norm(), 1e-8,
                           2 * smallest_height(scene.mesh.triangles, scene.mesh.rest)},
             scene.x);
  // a millionth of how strongly gravity holds a pendulum as long as the sheet
  const double extent = scene.mesh.rest.colwise().norm().maxCoeff();
  const double pendulum = scene.gravity.value().norm() / extent;  // 1/s^2
  const SparseFactors factors(
      hessian.at(resting_state(settled.x), Definiteness::exact, 1e-6 * pendulum));
  return {settled.x, settled.unbalanced, settled.steps, positive_pivots(factors)};
}

Scene equilateral_sheet(double rigidity, double young, double edge, int columns, int rows) {
  Scene scene =
      scene_at_rest(make_sheet({SheetPattern::equilateral, columns * edge, 0, columns, rows}), 0.2);
  const Eigen::Matrix3d R = oracles::relaxed_rigidity(oracles::equilateral_triangles(1));
  add_flat_hinges(scene, rigidity / oracles::cylinder_rigidity(R, 0), 0);
  scene.stretch = StretchMaterial{young, 0, 1};
  return scene;
}

}  // namespace foldproof
