#include "convergence/validation/freedoms.h"
#include "reference/mesh/shapes.h"
#include "verification/oracles/homogenised_bending.h"
#include "verification/specimens/specimens.h"

namespace foldproof {

namespace {

/// Displacements by one step of backward Euler, with the part of the derivative that is definite
/// where the exact one is not [m].
Eigen::VectorXd displacements(const Hessian& hessian, SparseFactors& factors, const PerParticle3& x,
                              const Eigen::VectorXd& force, double step) {
  const double mass_over = 1 / (step * step);
  factors.factorize(hessian.at(x, Definiteness::exact, mass_over));
  if (!positive_pivots(factors))
    factors.factorize(hessian.at(x, Definiteness::semidefinite, mass_over));
  return factors.solve(force);
}

}  // namespace

Eigen::VectorXd Freedoms::gather(const PerParticle3& forces) const {
  Eigen::VectorXd gathered = Eigen::VectorXd::Zero(count);
  for (Eigen::Index i = 0; i < forces.cols(); ++i)
    for (int axis = 0; axis < 3; ++axis) {
      const Freedom& freedom = of[std::size_t(i)][std::size_t(axis)];
      if (freedom.unknown >= 0)
        gathered[freedom.unknown] += share[std::size_t(i)] * freedom.by * forces(axis, i);
    }
  return gathered;
}

PerParticle3 Freedoms::moved(PerParticle3 x, const Eigen::VectorXd& by) const {
  for (Eigen::Index i = 0; i < x.cols(); ++i)
    for (int axis = 0; axis < 3; ++axis) {
      const Freedom& freedom = of[std::size_t(i)][std::size_t(axis)];
      if (freedom.unknown >= 0) x(axis, i) += freedom.by * by[freedom.unknown];
    }
  return x;
}

Freedoms freedoms_of(const Scene& scene) {
  const std::size_t particles = std::size_t(scene.mesh.particles());
  Freedoms freedoms{std::vector<std::array<Freedom, 3>>(particles),
                    std::vector<double>(particles, 1), 0};
  for (const int i : free_particles(scene))
    for (Freedom& freedom : freedoms.of[std::size_t(i)]) freedom.unknown = freedoms.count++;
  return freedoms;
}

Hessian::Hessian(const Scene& scene, const Freedoms& freedoms)
    : system_(build_system(scene)),
      freedoms_(freedoms),
      mass_(lumped_masses(scene.mesh, scene.density)) {}

SparseMatrix Hessian::at(const PerParticle3& x, Definiteness definiteness, double mass_over) const {
  Work work;
  const ForceDifferential d =
      elastic_differential_at(system_.forces, resting_state(x), definiteness, work);
  std::vector<Eigen::Triplet<double>> entries;
  const auto add = [&](int a, int b, const Eigen::Matrix3d& block) {
    const double share = freedoms_.share[std::size_t(a)];
    if (share == 0) return;
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) {
        const Freedom &row = freedoms_.of[std::size_t(a)][std::size_t(r)],
                      &column = freedoms_.of[std::size_t(b)][std::size_t(c)];
        if (row.unknown >= 0 && column.unknown >= 0)
          entries.emplace_back(row.unknown, column.unknown,
                               -share * row.by * column.by * block(r, c));
      }
  };
  for (const PairStiffness& pair : d.pairs) {
    add(pair.a, pair.a, pair.block);
    add(pair.b, pair.b, pair.block);
    add(pair.a, pair.b, -pair.block);
    add(pair.b, pair.a, -pair.block);
  }
  for (const HingeStiffness& hinge : d.hinges)
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j)
        add(hinge.particles[std::size_t(i)], hinge.particles[std::size_t(j)],
            hinge.block.block<3, 3>(3 * i, 3 * j));
  for (Eigen::Index i = 0; i < x.cols(); ++i)
    add(int(i), int(i), -mass_over * mass_[i] * Eigen::Matrix3d::Identity());
  SparseMatrix K(freedoms_.count, freedoms_.count);
  K.setFromTriplets(entries.begin(), entries.end());
  return K;
}

bool positive_pivots(const SparseFactors& factors) {
  return factors.info() == Eigen::Success && (factors.vectorD().array() > 0).all();
}

Settled settle(const Settling& settling, PerParticle3 x) {
  const Freedoms& freedoms = settling.freedoms;
  SparseFactors factors;
  factors.analyzePattern(settling.hessian.at(x, Definiteness::exact, 1));
  Settled rest{std::move(x), 0, 0};
  double step = 0.005;  // s
  for (; rest.steps < 600; ++rest.steps) {
    const Eigen::VectorXd force =
        freedoms.gather(settling.probe.elastic(resting_state(rest.x))) + settling.load;
    rest.unbalanced = force.cwiseQuotient(settling.scale).cwiseAbs().maxCoeff();
    if (rest.unbalanced < settling.tolerance) break;
    const Eigen::VectorXd by = displacements(settling.hessian, factors, rest.x, force, step);
    const double far = by.cwiseAbs().maxCoeff();
    if (!(far <= settling.longest)) {
      step /= 2;
      continue;
    }
    rest.x = freedoms.moved(rest.x, by);
    if (far < settling.longest / 4) step *= 1.5;
  }
  return rest;
}

Equilibrium equilibrium_of(const Subject& subject, const Scene& scene) {
  const Probe probe(subject, scene);
  const Freedoms freedoms = freedoms_of(scene);
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

Scene equilateral_sheet(double rigidity, double young, double edge, int columns, int rows) {
  Scene scene =
      scene_at_rest(make_sheet({SheetPattern::equilateral, columns * edge, 0, columns, rows}), 0.2);
  const Eigen::Matrix3d R = oracles::relaxed_rigidity(oracles::equilateral_triangles(1));
  add_flat_hinges(scene, rigidity / oracles::cylinder_rigidity(R, 0), 0);
  scene.stretch = StretchMaterial{young, 0, 1};
  return scene;
}

}  // namespace foldproof
