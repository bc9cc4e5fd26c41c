#include "verification/oracles/stability.h"

#include <cmath>
#include <limits>
#include <string>

#include "reference/types.h"
#include "verification/oracles/dense_algebra.h"

namespace foldproof::oracles {

namespace {

using Complex = std::complex<double>;

constexpr double epsilon = std::numeric_limits<double>::epsilon();

void require(bool holds, const std::string& what) {
  if (!holds) throw InputError("oracle stability: " + what);
}

/// |R(z)| by Horner's rule.
double amplification(int order, Complex z) {
  Complex sum = 1;
  for (int k = order; k >= 1; --k) sum = 1.0 + z / double(k) * sum;
  return std::abs(sum);
}

bool is_stable(int order, const std::vector<Complex>& rates, double h) {
  for (const Complex& rate : rates)
    if (!(amplification(order, h * rate) <= 1 + 8 * epsilon)) return false;
  return true;
}

/// The border between a stable and an unstable step [s], by bisection to the last digits.
template <class IsStable>
Estimate bisect(double stable, double unstable, const IsStable& is_stable_at) {
  for (int i = 0; i < 60; ++i) {
    const double middle = (stable + unstable) / 2;
    (is_stable_at(middle) ? stable : unstable) = middle;
  }
  return {stable, unstable - stable + 1e-10 * stable};
}

}  // namespace

std::vector<Complex> oscillator_rates(double omega, double zeta) {
  require(omega > 0 && std::isfinite(omega), "omega must be positive and finite");
  require(zeta >= 0 && std::isfinite(zeta), "zeta must be at least 0 and finite");
  if (zeta < 1) {
    const double turn = std::sqrt((1 - zeta) * (1 + zeta));
    return {omega * Complex(-zeta, turn), omega * Complex(-zeta, -turn)};
  }
  const double fast = zeta + std::sqrt((zeta - 1) * (zeta + 1));
  return {-omega * fast, -omega / fast};
}

std::vector<Complex> system_rates(const Eigen::MatrixXd& K, const Eigen::MatrixXd& C) {
  const Eigen::Index n = K.rows();
  require(K.allFinite() && C.allFinite(), "K and C must be finite");
  require(K.cols() == n && C.rows() == n && C.cols() == n,
          "K and C must be square and of one size");
  // (omega0 q, v)' = (omega0 v, -K q - C v): scaled so that both halves have similar magnitude
  const double omega0 = std::sqrt(K.norm());
  Eigen::MatrixXd matrix(2 * n, 2 * n);
  matrix << Eigen::MatrixXd::Zero(n, n), omega0 * Eigen::MatrixXd::Identity(n, n), -K / omega0, -C;
  const Eigen::VectorXcd values = eigenvalues(matrix);
  return {values.begin(), values.end()};
}

// No stability region of these four extends beyond |z| = 3.4 from 0; the search goes out in
// thousandths.
Estimate largest_runge_kutta_step(int order, const std::vector<Complex>& rates) {
  require(order >= 1 && order <= 4, "order must be 1, 2, 3 or 4");
  double fastest = 0;
  for (const Complex& rate : rates) {
    require(std::isfinite(std::abs(rate)), "rates must be finite");
    if (std::abs(rate) > fastest) fastest = std::abs(rate);
  }
  require(fastest > 0, "one rate at least must not vanish");
  const double stride = 0.001 / fastest;
  for (int i = 1; i < 4000; ++i) {
    if (is_stable(order, rates, i * stride)) continue;
    if (i == 1) return {0, 0};
    return bisect((i - 1) * stride, i * stride,
                  [&](double h) { return is_stable(order, rates, h); });
  }
  throw InputError("oracle stability: no limit of Runge-Kutta of order " + std::to_string(order));
}

Estimate largest_leapfrog_step(const Eigen::MatrixXd& K) {
  require(K.allFinite() && K.rows() > 0, "K must be finite");
  const double squared = symmetric_eigenvalues(K)[K.rows() - 1];
  require(squared > 0, "K must have a positive eigenvalue");
  const double h = 2 / std::sqrt(squared);
  return {h, double(K.rows()) * epsilon * h};
}

// The smallest eigenvalue of (4 + 2 h C - h^2 K)/h^2 falls with h: it changes its sign once.
Estimate largest_variable_newmark_step(const Eigen::MatrixXd& K, const Eigen::MatrixXd& C) {
  const auto is_positive = [&](double h) {
    const Eigen::MatrixXd matrix =
        4 * Eigen::MatrixXd::Identity(K.rows(), K.rows()) + 2 * h * C - h * h * K;
    return symmetric_eigenvalues(matrix)[0] > 0;
  };
  const double least = largest_leapfrog_step(K).value * (1 - 1e-9);
  double beyond = 2 * least;
  for (int i = 0; i < 60 && is_positive(beyond); ++i) beyond *= 2;
  return bisect(least, beyond, is_positive);
}

Estimate bdf2_largest_ratio() { return {1 + std::sqrt(2.0), epsilon}; }

double undamped_growth(double omega_h) {
  require(omega_h >= 0 && omega_h < 2, "omega h must be at least 0 and below 2");
  return 1 / std::sqrt((1 - omega_h / 2) * (1 + omega_h / 2));
}

}  // namespace foldproof::oracles
