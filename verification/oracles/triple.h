#pragma once

#include <array>
#include <cmath>

namespace foldproof::oracles {

/// A vector in space over any scalar: double, 50 digits, or an automatically differentiated number.
/// Deliberately plain: linear algebra libraries need traits of a scalar, this needs only + - * /
/// and sqrt.
template <class Scalar>
struct Triple {
  Scalar x{}, y{}, z{};

  friend Triple operator+(const Triple& p, const Triple& q) {
    return {p.x + q.x, p.y + q.y, p.z + q.z};
  }
  friend Triple operator-(const Triple& p, const Triple& q) {
    return {p.x - q.x, p.y - q.y, p.z - q.z};
  }
  friend Triple operator-(const Triple& p) { return {-p.x, -p.y, -p.z}; }
  friend Triple operator*(const Scalar& s, const Triple& p) { return {s * p.x, s * p.y, s * p.z}; }
  friend Triple operator/(const Triple& p, const Scalar& s) { return {p.x / s, p.y / s, p.z / s}; }
};

/// The four corners of a hinge, or one vector for each of them, in the order x1, x2, x3, x4.
template <class Scalar>
using Quad = std::array<Triple<Scalar>, 4>;

template <class Scalar>
Scalar dot(const Triple<Scalar>& p, const Triple<Scalar>& q) {
  return p.x * q.x + p.y * q.y + p.z * q.z;
}

template <class Scalar>
Triple<Scalar> cross(const Triple<Scalar>& p, const Triple<Scalar>& q) {
  return {p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x};
}

template <class Scalar>
Scalar length(const Triple<Scalar>& p) {
  using std::sqrt;
  return sqrt(dot(p, p));
}

template <class Scalar>
Triple<Scalar> unit(const Triple<Scalar>& p) {
  return p / length(p);
}

}  // namespace foldproof::oracles
