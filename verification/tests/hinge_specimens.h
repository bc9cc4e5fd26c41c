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
  HingeInput hinge;
  hinge.x = {Vector3(-.71, .13, .36), Vector3(.59, .44, .27), Vector3(.04, -.03, -.11),
             Vector3(-.06, .05, .83)};
  hinge.v = {Vector3(.31, -1.2, .45), Vector3(-.62, .83, .17), Vector3(.92, .24, -.53),
             Vector3(-.14, .37, .76)};
  hinge.rest = {Vector3(-.8, .02, .3), Vector3(.67, 0, .41), Vector3(.01, 0, -.07),
                Vector3(0, .03, .9)};
  hinge.ke = 3.7e-3;
  hinge.kd = 4.1e-4;
  hinge.theta0 = .63;
  return hinge;
}

/// Folded beyond a right angle the other way, small and thin.
inline HingeInput second_hinge() {
  HingeInput hinge;
  hinge.x = {Vector3(.045, .014, .017), Vector3(.031, .052, .024), Vector3(.003, .001, .002),
             Vector3(.009, .012, .061)};
  hinge.v = {Vector3(1.7, .3, -.6), Vector3(-.9, 2.3, .8), Vector3(.5, -.7, 1.1),
             Vector3(.2, .6, -1.3)};
  hinge.rest = {Vector3(-.05, .003, .01), Vector3(.06, .002, .02), Vector3(0, .001, 0),
                Vector3(.004, 0, .057)};
  hinge.ke = 2.9e-5;
  hinge.kd = 1.3e-6;
  hinge.theta0 = -.87;
  return hinge;
}

inline std::array<HingeInput, 2> hinges() { return {first_hinge(), second_hinge()}; }

inline double size(const Corners& p) {
  double sum = 0;
  for (const Vector3& vector : p) sum += vector.norm();
  return sum;
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
