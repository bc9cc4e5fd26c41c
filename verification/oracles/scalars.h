#pragma once

#include <array>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <compare>
#include <concepts>
#include <cstddef>
#include <limits>

#include "verification/oracles/estimate.h"

namespace foldproof::oracles {

/// Fifty decimal digits: a formula that loses half of them to cancellation still gives a correctly
/// rounded double. Only this header includes Boost.
using Digits50 = boost::multiprecision::cpp_bin_float_50;

/// Whole numbers of any length. A double is a whole number times a power of two, so that sums and
/// products of doubles over a common power are exact.
using Whole = boost::multiprecision::cpp_int;

/// The error of rounding a number near value to double: half a unit in the last place; at zero, the
/// smallest normal number.
inline double one_rounding(double value) {
  return 0.5 * std::numeric_limits<double>::epsilon() * std::abs(value) +
         std::numeric_limits<double>::min();
}

/// The nearest double and its rounding.
inline Estimate rounded(const Digits50& value) {
  const double nearest = value.convert_to<double>();
  return {nearest, one_rounding(nearest)};
}

/// A number that carries its derivatives with respect to N variables (forward automatic
/// differentiation): value + sum_i derivative[i] dx_i, exact to the rounding of Scalar. Scalar may
/// itself be a Dual, which gives second derivatives. Where a function has no derivative (sqrt, abs,
/// atan2 at the origin; acos at +-1) the derivatives come out as infinity or NaN, never as a
/// plausible number.
template <class Scalar, int N>
struct Dual {
  Scalar value{};
  std::array<Scalar, static_cast<std::size_t>(N)> derivative{};

  Dual() = default;

  /// A constant: all derivatives are zero.
  template <class Number>
  requires std::convertible_to<Number, Scalar> Dual(const Number& constant) : value(constant) {}

  friend Dual operator+(const Dual& p, const Dual& q) {
    return p.combined(p.value + q.value, 1, q, 1);
  }
  friend Dual operator-(const Dual& p, const Dual& q) {
    return p.combined(p.value - q.value, 1, q, -1);
  }
  friend Dual operator-(const Dual& p) { return p.chained(-p.value, -1); }
  friend Dual operator*(const Dual& p, const Dual& q) {
    return p.combined(p.value * q.value, q.value, q, p.value);
  }
  friend Dual operator/(const Dual& p, const Dual& q) {
    const Scalar quotient = p.value / q.value;
    return p.combined(quotient, Scalar(1) / q.value, q, -quotient / q.value);
  }

  friend bool operator==(const Dual& p, const Dual& q) { return p.value == q.value; }
  friend bool operator<(const Dual& p, const Dual& q) { return p.value < q.value; }
  friend bool operator>(const Dual& p, const Dual& q) { return p.value > q.value; }
  friend bool operator<=(const Dual& p, const Dual& q) { return p.value <= q.value; }
  friend bool operator>=(const Dual& p, const Dual& q) { return p.value >= q.value; }

  friend Dual sqrt(const Dual& p) {
    using std::sqrt;
    const Scalar root = sqrt(p.value);
    return p.chained(root, Scalar(1) / (Scalar(2) * root));
  }

  friend Dual sin(const Dual& p) {
    using std::cos, std::sin;
    return p.chained(sin(p.value), cos(p.value));
  }

  friend Dual cos(const Dual& p) {
    using std::cos, std::sin;
    return p.chained(cos(p.value), -sin(p.value));
  }

  friend Dual acos(const Dual& p) {
    using std::acos, std::sqrt;
    return p.chained(acos(p.value), Scalar(-1) / sqrt(Scalar(1) - p.value * p.value));
  }

  friend Dual abs(const Dual& p) {
    using std::abs;
    const Scalar size = abs(p.value);
    return p.chained(size, p.value / size);
  }

  /// The angle of the point (x, y): d atan2 = (x dy - y dx) / (x^2 + y^2).
  friend Dual atan2(const Dual& y, const Dual& x) {
    using std::atan2;
    const Scalar squared_radius = x.value * x.value + y.value * y.value;
    return y.combined(atan2(y.value, x.value), x.value / squared_radius, x,
                      -y.value / squared_radius);
  }

 private:
  /// f(this), given the value and the slope of f there.
  Dual chained(const Scalar& image, const Scalar& slope) const {
    Dual result(image);
    for (std::size_t i = 0; i < derivative.size(); ++i)
      result.derivative[i] = slope * derivative[i];
    return result;
  }

  /// f(this, other), given the value and the two partial slopes of f there.
  Dual combined(const Scalar& image, const Scalar& slope, const Dual& other,
                const Scalar& other_slope) const {
    Dual result(image);
    for (std::size_t i = 0; i < derivative.size(); ++i) {
      result.derivative[i] = slope * derivative[i] + other_slope * other.derivative[i];
    }
    return result;
  }
};

/// The i-th of the N variables of differentiation, at the given value. 0 <= i < N.
template <class Scalar, int N>
Dual<Scalar, N> variable(const Scalar& value, int i) {
  Dual<Scalar, N> result(value);
  result.derivative.at(static_cast<std::size_t>(i)) = Scalar(1);
  return result;
}

}  // namespace foldproof::oracles
