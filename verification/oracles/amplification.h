#pragma once

#include <array>
#include <complex>
#include <string_view>

#include "verification/oracles/exact_solutions.h"

// What one step of a method makes of a linear oscillator: the numbers by which its two modes
// are multiplied.

namespace foldproof::oracles {

/// The factors of the two modes, in the order of the roots of lambda^2 + c lambda + k = 0 with +
/// and - before the square root. Good to about ten roundings of 1.
using Factors = std::array<std::complex<double>, 2>;

/// e^{lambda h}, the truth. h [s] > 0.
Factors exact_factors(const Oscillator& oscillator, double h);

/// What the method makes of it, with z = lambda h:
///   forward-euler, RK2, SSP-RK3, RK4        1 + z + ... + z^p/p!, p = 1, 2, 3, 4 (p stages of
///                                           order p leave no other polynomial)
///   backward-euler, linear-backward-euler   1/(1 - z)
///   implicit-midpoint                       (1 + z/2)/(1 - z/2)
///   BDF2                                    (2 + sqrt(1 + 2 z))/(3 - 2 z), the root that tends to
///                                           e^z; constant steps
///   A, B, C                                 the eigenvalues of step_matrix
/// Any other name: InputError.
Factors step_factors(std::string_view method, const Oscillator& oscillator, double h);

}  // namespace foldproof::oracles
