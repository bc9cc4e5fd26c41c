#pragma once

#include <functional>
#include <span>

#include "verification/oracles/estimate.h"
#include "verification/oracles/ode.h"

// Wrappers of the GNU Scientific Library: only gsl.cpp includes its headers. GSL's error handler,
// which would abort, is turned off; every status is checked and becomes a std::runtime_error with
// GSL's message.

namespace foldproof::oracles {

/// y' = rhs(t, y) from y(t0) = y0, at the given times (ascending, none before t0).
///
/// The values come from the eighth-order Prince-Dormand pair (rk8pd) with a local error of
/// tolerance (1 + |y_i|) per step and component. The uncertainty is the largest difference, over
/// all components, from two other solutions: the same method at ten times the tolerance, and the
/// fifth-order Cash-Karp pair (rkck) at the tolerance. It covers the worst of the three and is
/// usually too large for the best. Adams' method (msadams) is a poorer second opinion: after five
/// periods of an oscillator it errs by 700 times its tolerance, rkck by seven times. tolerance in
/// [1e-14, 1e-3]; 1e-13 suits smooth problems of size 1. Bad arguments: InputError. A right-hand
/// side that is not finite, or a step that GSL cannot take: std::runtime_error; an exception thrown
/// by the right-hand side is rethrown unchanged.
ReferenceSolution reference_solution(const RightHandSide& rhs, std::span<const double> y0,
                                     double t0, std::span<const double> times, double tolerance);

/// The root of f in [lower, upper], by Brent's method until the bracket is as narrow as `width` or
/// as doubles allow. f has opposite signs at the two ends (else InputError). The uncertainty is the
/// final width.
Estimate bracketed_root(const std::function<double(double)>& f, double lower, double upper,
                        double width);

}  // namespace foldproof::oracles
