#include "reference/dynamics/freedoms.h"

#include <cmath>

namespace foldproof {

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

Freedoms freedoms_of(const System& system) {
  const std::size_t particles = std::size_t(system.mass.size());
  Freedoms freedoms{std::vector<std::array<Freedom, 3>>(particles),
                    std::vector<double>(particles, 1), 0};
  for (std::size_t i = 0; i < particles; ++i)
    if (system.inverse_mass[Eigen::Index(i)] > 0)
      for (Freedom& freedom : freedoms.of[i]) freedom.unknown = freedoms.count++;
  return freedoms;
}

SparseMatrix Hessian::at(const State& s, Definiteness definiteness, double mass_over,
                         std::span<const AddedStiffness> added) const {
  Work work;
  const ForceDifferential d = elastic_differential_at(forces_, s, definiteness, work);
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
  for (Eigen::Index i = 0; i < s.x.cols(); ++i)
    add(int(i), int(i), -mass_over * mass_[i] * Eigen::Matrix3d::Identity());
  for (const AddedStiffness& one : added) add(one.a, one.b, -one.block);
  SparseMatrix K(freedoms_.count, freedoms_.count);
  K.setFromTriplets(entries.begin(), entries.end());
  return K;
}

bool positive_pivots(const SparseFactors& factors) {
  return factors.info() == Eigen::Success && (factors.vectorD().array() > 0).all();
}

Mode slowest_mode(const SparseMatrix& K, const Eigen::VectorXd& mass, double scale) {
  SparseMatrix M(K.rows(), K.cols());
  M.reserve(Eigen::VectorXi::Constant(K.cols(), 1));
  for (Eigen::Index i = 0; i < mass.size(); ++i) M.insert(i, i) = mass[i];
  // a shift below the spectrum
  double shift = -1e-6 * scale;
  SparseFactors factors;
  factors.analyzePattern(K + M);
  const auto is_below = [&](double value) {
    factors.factorize(K - value * M);
    return positive_pivots(factors);
  };
  double inside = 0;  // not below all eigenvalues, if the search had to go on
  while (!is_below(shift)) {
    inside = shift;
    shift *= 4;
    if (!std::isfinite(shift)) return {shift};
  }
  // nearer to the smallest, by halves, so that the iteration is fast
  for (int k = 0; k < 30 && inside - shift > 1e-3 * -shift && inside < 0; ++k) {
    const double middle = (inside + shift) / 2;
    (is_below(middle) ? shift : inside) = middle;
  }
  is_below(shift);
  Eigen::VectorXd u(K.rows());
  for (Eigen::Index i = 0; i < u.size(); ++i) u[i] = 1 + 0.5 * std::sin(1.7 * double(i));
  double value = 0, before = 1;
  for (int k = 0; k < 300 && !(std::abs(value - before) < 1e-7 * (std::abs(value) + scale)); ++k) {
    u = factors.solve(Eigen::VectorXd(mass.asDiagonal() * u));
    u /= std::sqrt(u.dot(mass.asDiagonal() * u));
    before = value;
    value = u.dot(K * u);
  }
  return {value, u};
}

}  // namespace foldproof
