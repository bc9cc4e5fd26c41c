#pragma once

#include <array>
#include <complex>
#include <string_view>

#include "verification/oracles/exact_solutions.h"

// Amplification factors of one step of a method on a linear oscillator, one for each of its two
// modes.

namespace foldproof::oracles {

/// The factors of the two modes, in the order of the roots of lambda^2 + c lambda + k = 0 with +
/// and - before the square root. Accurate to about ten roundings of 1.
using Factors = std::array<std::complex<double>, 2>;

/// e^{lambda h}, the exact factors. h [s] > 0.
Factors exact_factors(const Oscillator& oscillator, double h);

/// The factors of the method, with z = lambda h:
///   forward-euler, RK2, SSP-RK3, RK4        1 + z + ... + z^p/p!, p = 1, 2, 3, 4 (p stages
///                                           and order p allow no other polynomial)
///   backward-euler, linear-backward-euler   1/(1 - z)
///   implicit-midpoint                       (1 + z/2)/(1 - z/2)
///   BDF2                                    (2 + sqrt(1 + 2 z))/(3 - 2 z), the root that tends to
///                                           e^z; constant steps
///   A, B, C                                 the eigenvalues of step_matrix
/// Any other name: InputError.
Factors step_factors(std::string_view method, const Oscillator& oscillator, double h);

}  // namespace foldproof::oracles
