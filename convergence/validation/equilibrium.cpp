#include "convergence/validation/equilibrium.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <vector>

#include "verification/specimens/probe.h"
#include "verification/specimens/specimens.h"

namespace foldproof {

namespace {

using Sparse = Eigen::SparseMatrix<double>;
using Factors = Eigen::SimplicialLDLT<Sparse>;

/// The free particles' equations, three for each.
struct FreeParticles {
  std::vector<int> number;  // -1: held
  int count = 0;

  explicit FreeParticles(const Scene& scene) : number(std::size_t(scene.mesh.particles()), 0) {
    for (const PrescribedParticle& held : scene.prescribed) number[std::size_t(held.particle)] = -1;
    for (int& n : number)
      if (n == 0) n = count++;
  }

  int of(int particle) const { return number[std::size_t(particle)]; }

  Eigen::VectorXd gather(const PerParticle3& values) const {
    Eigen::VectorXd free(3 * count);
    for (Eigen::Index i = 0; i < values.cols(); ++i)
      if (of(int(i)) >= 0) free.segment<3>(3 * of(int(i))) = values.col(i);
    return free;
  }

  PerParticle3 moved(PerParticle3 x, const Eigen::VectorXd& by) const {
    for (Eigen::Index i = 0; i < x.cols(); ++i)
      if (of(int(i)) >= 0) x.col(i) += by.segment<3>(3 * of(int(i)));
    return x;
  }
};

/// The derivative of the energy's gradient over the free particles, plus `mass_over` [1/s^2]
/// times the masses.
class Hessian {
 public:
  Hessian(const Scene& scene, const FreeParticles& free)
      : system_(build_system(scene)),
        free_(free),
        mass_(lumped_masses(scene.mesh, scene.density)) {}

  Sparse at(const PerParticle3& x, Definiteness definiteness, double mass_over) const {
    Work work;
    const ForceDifferential d =
        elastic_differential_at(system_.forces, resting_state(x), definiteness, work);
    std::vector<Eigen::Triplet<double>> entries;
    const auto add = [&](int a, int b, const Eigen::Matrix3d& block) {
      if (free_.of(a) < 0 || free_.of(b) < 0) return;
      for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c)
          entries.emplace_back(3 * free_.of(a) + r, 3 * free_.of(b) + c, -block(r, c));
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
    Sparse K(3 * free_.count, 3 * free_.count);
    K.setFromTriplets(entries.begin(), entries.end());
    return K;
  }

 private:
  System system_;
  const FreeParticles& free_;
  PerParticle mass_;
};

bool positive_pivots(const Factors& factors) {
  return factors.info() == Eigen::Success && (factors.vectorD().array() > 0).all();
}

/// Displacements by one step of backward Euler, with the part of the derivative that is definite
/// where the exact one is not [m].
Eigen::VectorXd displacements(const Hessian& hessian, Factors& factors, const PerParticle3& x,
                              const Eigen::VectorXd& force, double step) {
  const double mass_over = 1 / (step * step);
  factors.factorize(hessian.at(x, Definiteness::exact, mass_over));
  if (!positive_pivots(factors))
    factors.factorize(hessian.at(x, Definiteness::semidefinite, mass_over));
  return factors.solve(force);
}

}  // namespace

Equilibrium equilibrium_of(const Subject& subject, const Scene& scene) {
  const Probe probe(subject, scene);
  const FreeParticles free(scene);
  const Hessian hessian(scene, free);
  const double longest = 2 * smallest_height(scene.mesh.triangles, scene.mesh.rest);
  const Eigen::VectorXd masses =
      free.gather(lumped_masses(scene.mesh, scene.density).transpose().replicate(3, 1));
  const Eigen::VectorXd weights = masses * scene.gravity.value().norm();
  Factors factors;
  factors.analyzePattern(hessian.at(scene.x, Definiteness::exact, 1));

  Equilibrium rest{scene.x, 0, 0, false};
  double step = 0.005;  // s
  for (; rest.steps < 600; ++rest.steps) {
    const Eigen::VectorXd force = free.gather(probe.elastic(resting_state(rest.x)));
    rest.unbalanced = force.cwiseQuotient(weights).cwiseAbs().maxCoeff();
    if (rest.unbalanced < 1e-8) break;
    const Eigen::VectorXd by = displacements(hessian, factors, rest.x, force, step);
    const double far = by.cwiseAbs().maxCoeff();
    if (!(far <= longest)) {
      step /= 2;
      continue;
    }
    rest.x = free.moved(rest.x, by);
    if (far < longest / 4) step *= 1.5;
  }
  // a millionth of how strongly gravity holds a pendulum as long as the sheet
  const double extent = scene.mesh.rest.colwise().norm().maxCoeff();
  const double pendulum = scene.gravity.value().norm() / extent;  // 1/s^2
  factors.factorize(hessian.at(rest.x, Definiteness::exact, 1e-6 * pendulum));
  rest.stable = positive_pivots(factors);
  return rest;
}

}  // namespace foldproof
