// Stability limits of methods on linear motion, from the literature and a few lines of algebra.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

#include "verification/oracles/estimate.h"

namespace foldproof::oracles {

/// The rates lambda of exp(lambda t), the solutions of x'' = -omega^2 x - 2 zeta omega x': two
/// values [1/s]. InputError unless omega > 0 and zeta >= 0.
std::vector<std::complex<double>> oscillator_rates(double omega, double zeta);

/// The same for q'' = -K q - C q': 2 n values. K, C: n x n [1/s^2], [1/s], in
/// mass-weighted coordinates.
std::vector<std::complex<double>> system_rates(const Eigen::MatrixXd& K, const Eigen::MatrixXd& C);

/// The step h [s] at which an explicit Runge-Kutta method with as many stages as its order (1 to 4)
/// becomes unstable: |R(h lambda)| <= 1 for all rates below it, R(z) = sum_{k <= order} z^k/k!
/// (Hairer, Wanner, Solving ODEs II, section IV.2). 0 if it is unstable for any step. Rates have
/// real parts <= 0.
Estimate largest_runge_kutta_step(int order, const std::vector<std::complex<double>>& rates);

/// The step h [s] at which schemes A and B become unstable on q'' = -K q - C q': 2/sqrt of the
/// largest eigenvalue of K, for any C. There the eigenvalue of the step is -1. With q' = -q, v' =
/// -v the trapezoidal line v' - v = -h/2 (K (q + q') + C (v + v')) gives v = 0 and the move -2 q =
/// -h^2/2 K q.
Estimate largest_leapfrog_step(const Eigen::MatrixXd& K);

/// The same for scheme C: the eigenvalue is -1 where 4 + 2 h C - h^2 K becomes singular, as there v
/// = 0 and the move -2 q = h (1 + h/2 C)^{-1} (-h/2 K q).
Estimate largest_variable_newmark_step(const Eigen::MatrixXd& K, const Eigen::MatrixXd& C);

/// The constant step ratio r above which BDF2 amplifies differences of solutions of y' = 0: they
/// are multiplied by r^2/(1 + 2 r) a step, which is 1 at r = 1 + sqrt(2).
Estimate bdf2_largest_ratio();

/// Largest sqrt(energy) over the start's in the undamped leapfrog: with c = omega h/2 it keeps
/// v^2 + (1 - c^2) omega^2 x^2, hence 1/sqrt(1 - c^2). Needs 0 <= omega h < 2.
double undamped_growth(double omega_h);

}  // namespace foldproof::oracles
