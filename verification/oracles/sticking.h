// Sticking as defined, in 50 digits with automatic differentiation: the target, its motion with the
// corners of its triangles, and the spring's force as minus the gradient of its energy (BMF03
// section 6).
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "reference/types.h"

namespace foldproof::oracles {

/// A particle and the triangles that it sticks to, one or two. The inputs count as exact.
struct StuckParticle {
  Vector3 x;                                    // m
  std::vector<std::array<Vector3, 3>> corners;  // a, b, c of each [m]
  std::vector<Vector3> places;                  // in each: weights of b and c [1], height [m]
  double stiffness, far;                        // k0 [N/m], distance at which it breaks [m]
};

struct StickingAnswer {
  Vector3 target;              // the mean of a + w_b (b - a) + w_c (c - a) + height n [m]
  Eigen::MatrixXd derivative;  // of the target by the corners, in order: 3 x 9 or 3 x 18
  double stiffness;            // k(d) [N/m]
  double energy;               // k0 (d^2/2 - d^4/(2 far^2) + d^6/(6 far^4)) [J]
  Eigen::VectorXd force;       // minus its gradient by particle and corners: 12 or 21 [N]
};

/// All numbers are accurate to their rounding.
StickingAnswer sticking_answer(const StuckParticle& stuck);

}  // namespace foldproof::oracles
