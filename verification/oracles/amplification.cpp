#include "verification/oracles/amplification.h"

#include <Eigen/LU>
#include <cmath>
#include <string>

namespace foldproof::oracles {

namespace {

using Complex = std::complex<double>;

/// z = lambda h of the two modes.
Factors exponents(const Oscillator& oscillator, double h) {
  if (!(h > 0)) throw InputError("oracle amplification: the step h must be > 0 s");
  if (!(oscillator.stiffness >= 0) || !(oscillator.damping >= 0))
    throw InputError("oracle amplification: Oscillator stiffness and damping must be at least 0");
  const double half = oscillator.damping / 2;
  const Complex root = std::sqrt(Complex(half * half - oscillator.stiffness));
  return {h * (-half + root), h * (-half - root)};
}

Complex taylor(Complex z, int order) {
  Complex sum = 1;
  for (int k = order; k >= 1; --k) sum = 1.0 + z / double(k) * sum;
  return sum;
}

Factors eigenvalues(const Eigen::Matrix2d& matrix) {
  const double half_trace = matrix.trace() / 2;
  const Complex root = std::sqrt(Complex(half_trace * half_trace - matrix.determinant()));
  return {half_trace + root, half_trace - root};
}

Complex factor(std::string_view method, Complex z) {
  if (method == "forward-euler") return taylor(z, 1);
  if (method == "RK2") return taylor(z, 2);
  if (method == "SSP-RK3") return taylor(z, 3);
  if (method == "RK4") return taylor(z, 4);
  if (method == "backward-euler" || method == "linear-backward-euler") return 1.0 / (1.0 - z);
  if (method == "implicit-midpoint") return (1.0 + z / 2.0) / (1.0 - z / 2.0);
  if (method == "BDF2") return (2.0 + std::sqrt(1.0 + 2.0 * z)) / (3.0 - 2.0 * z);
  throw InputError("oracle amplification: no factors are known of the method '" +
                   std::string(method) + "'");
}

}  // namespace

Factors exact_factors(const Oscillator& oscillator, double h) {
  const Factors z = exponents(oscillator, h);
  return {std::exp(z[0]), std::exp(z[1])};
}

Factors step_factors(std::string_view method, const Oscillator& oscillator, double h) {
  const Factors z = exponents(oscillator, h);
  if (method == "A") return eigenvalues(step_matrix(Scheme::mixed, oscillator, h));
  if (method == "B") return eigenvalues(step_matrix(Scheme::central_newmark, oscillator, h));
  if (method == "C") return eigenvalues(step_matrix(Scheme::variable_step_newmark, oscillator, h));
  return {factor(method, z[0]), factor(method, z[1])};
}

}  // namespace foldproof::oracles
