// Common alternatives to the paper's bending element, as defined by their
// authors: forces on one hinge.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "verification/specimens/specimens.h"

namespace foldproof {

/// A bending model of two triangles: forces on x1..x4 [N] at the corners x, for rest corners and
/// stiffness 1 in the model's own unit (only their directions and proportions are compared).
struct BendingAlternative {
  std::string name, words, source;
  std::function<std::array<Vector3, 4>(const Corners& x, const Corners& rest)> force;
};

/// A spring across the hinge; gradients with lengths taken as constant; quadratic bending.
std::vector<BendingAlternative> bending_alternatives();

/// Gradient of theta by the shortcut that differentiates n1, n2 and e as if |N1|, |N2| (and, with
/// `edge_length` constant, |E|) did not change [1/m].
enum class EdgeLength { differentiated, taken_as_constant };
std::array<Vector3, 4> shortcut_gradient(const Corners& x, EdgeLength edge_length);

/// Discrete Shells (Grinspun, Hirani, Desbrun, Schroeder 2003): the energy of a hinge of stiffness
/// 1 J is (theta - theta0)^2 |E|/h, with h a third of the mean height of its triangles at rest.
/// Forces on x1..x4 [N] for the rest angle theta0 [rad].
std::array<Vector3, 4> discrete_shells_force(const Corners& x, const Corners& rest,
                                             double rest_angle);

/// The quadratic model's energy [J] for stiffness 1 J and a flat rest shape.
double quadratic_bending_energy(const Corners& x, const Corners& rest);

}  // namespace foldproof
