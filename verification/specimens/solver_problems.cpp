#include "verification/specimens/solver_problems.h"

#include <cmath>

#include "verification/specimens/random.h"

namespace foldproof {

namespace {

Eigen::MatrixXd dense_damping(const DampingOperator& damping, Eigen::Index particles) {
  Eigen::MatrixXd D = Eigen::MatrixXd::Zero(3 * particles, 3 * particles);
  const auto add = [&](const std::vector<int>& who, const std::vector<Vector3>& w) {
    for (size_t i = 0; i < who.size(); ++i)
      for (size_t j = 0; j < who.size(); ++j)
        D.block<3, 3>(3 * who[i], 3 * who[j]) -= w[i] * w[j].transpose();
  };
  for (const PairDamper& p : damping.pairs) add({p.a, p.b}, {-p.along, p.along});
  for (const HingeDamper& h : damping.hinges)
    add({h.particles.begin(), h.particles.end()},
        {h.w1, h.w2, -(h.weight1 * h.w1 + h.weight2 * h.w2),
         -((1 - h.weight1) * h.w1 + (1 - h.weight2) * h.w2)});
  return D;
}

}  // namespace

System system_of(const PerParticle& mass, const PerParticle& inverse_mass,
                 const SolverSettings& settings) {
  System system;
  system.mass = mass;
  system.inverse_mass = inverse_mass;
  system.solver = settings;
  return system;
}

Problem make_problem(const Scene& scene, unsigned seed) {
  Problem problem{build_system(scene), start_state(scene), {}, {}};
  Work work;
  problem.damping = *damping_at(problem.system.forces, problem.s, work);
  problem.guess = Random(seed).vectors(problem.s.x.cols(), 0.9);
  return problem;
}

DenseProblem make_dense(const Problem& problem, double s) {
  const Eigen::Index n = problem.guess.size();
  const Eigen::MatrixXd D = dense_damping(problem.damping, problem.guess.cols());
  const Eigen::VectorXd w0 = problem.guess.reshaped();
  DenseProblem dense;
  Eigen::VectorXd known = w0, mass(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    mass[k] = problem.system.mass[k / 3];
    if (problem.system.inverse_mass[k / 3] == 0) continue;
    known[k] = 0;
    dense.free.push_back(k);
  }
  const Eigen::MatrixXd whole = Eigen::MatrixXd(mass.asDiagonal()) - s * D;
  const Eigen::VectorXd pull = s * (D * known);
  dense.A = whole(dense.free, dense.free);
  dense.mass = mass(dense.free);
  dense.momentum = dense.mass.cwiseProduct(Eigen::VectorXd(w0(dense.free)));
  dense.b = dense.momentum + pull(dense.free);
  return dense;
}

double weighted_norm(const Eigen::VectorXd& r, const Eigen::VectorXd& mass) {
  return std::sqrt(r.cwiseAbs2().cwiseQuotient(mass).sum());
}

double scale_of(const DenseProblem& dense, ResidualScale scale) {
  if (scale == ResidualScale::momentum) return weighted_norm(dense.momentum, dense.mass);
  const Eigen::VectorXd w0 = dense.momentum.cwiseQuotient(dense.mass);
  return weighted_norm(dense.b - dense.A * w0, dense.mass);
}

}  // namespace foldproof
