// Two hinges at parameter points that share no value, and norms over all four corners.
#pragma once

#include <array>
#include <cmath>

#include "verification/oracles/definitions.h"

namespace foldproof::oracles {

using Corners = std::array<Vector3, 4>;

// u and the forces are rounded once each; sums of up to twelve such numbers stay within this
// many times epsilon
constexpr double roundings = 16 * std::numeric_limits<double>::epsilon();

inline HingeInput first_hinge() {
  return {{Vector3(-.71, .13, .36), {.59, .44, .27}, {.04, -.03, -.11}, {-.06, .05, .83}},
          {Vector3(.31, -1.2, .45), {-.62, .83, .17}, {.92, .24, -.53}, {-.14, .37, .76}},
          {Vector3(-.8, .02, .3), {.67, 0, .41}, {.01, 0, -.07}, {0, .03, .9}},
          3.7e-3,
          4.1e-4,
          .63};
}

/// Folded beyond a right angle the other way, small and thin.
inline HingeInput second_hinge() {
  return {{Vector3(.045, .014, .017), {.031, .052, .024}, {.003, .001, .002}, {.009, .012, .061}},
          {Vector3(1.7, .3, -.6), {-.9, 2.3, .8}, {.5, -.7, 1.1}, {.2, .6, -1.3}},
          {Vector3(-.05, .003, .01), {.06, .002, .02}, {0, .001, 0}, {.004, 0, .057}},
          2.9e-5,
          1.3e-6,
          -.87};
}

inline std::array<HingeInput, 2> hinges() { return {first_hinge(), second_hinge()}; }

inline double size(const Corners& p) {
  return p[0].norm() + p[1].norm() + p[2].norm() + p[3].norm();
}

inline double distance(const Corners& p, const Corners& q) {
  return size({p[0] - q[0], p[1] - q[1], p[2] - q[2], p[3] - q[3]});
}

inline double dot(const Corners& p, const Corners& q) {
  return p[0].dot(q[0]) + p[1].dot(q[1]) + p[2].dot(q[2]) + p[3].dot(q[3]);
}

inline Corners scaled(double factor, const Corners& p) {
  return {factor * p[0], factor * p[1], factor * p[2], factor * p[3]};
}

}  // namespace foldproof::oracles
