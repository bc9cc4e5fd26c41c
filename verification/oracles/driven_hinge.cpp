#include "verification/oracles/driven_hinge.h"

#include <cmath>

namespace foldproof::oracles {

namespace {

PerParticle3 as_columns(const std::array<Vector3, 4>& corners) {
  PerParticle3 columns(3, 4);
  for (int i = 0; i < 4; ++i) columns.col(i) = corners[static_cast<std::size_t>(i)];
  return columns;
}

/// Area of a triangle by Heron's formula from its sides [m^2]: independent of the hinge's cross
/// products.
double triangle_area(const Vector3& p, const Vector3& q, const Vector3& r) {
  const double a = (q - p).norm(), b = (r - q).norm(), c = (p - r).norm(), half = (a + b + c) / 2;
  return std::sqrt(half * (half - a) * (half - b) * (half - c));
}

}  // namespace

//      0            springs 0-2, 0-3 carry the first triangle, 1-2, 1-3 the second, 2-3 both
//     /  \          masses: corners 0 and 1 a third of one triangle, 2 and 3 a third of both
//   2 ---- 3
//     \  /
//      1
ClothDefinition driven_hinge(const DrivenHinge& problem) {
  if (!(problem.density > 0)) throw InputError("oracle driven_hinge: density must be positive");
  const std::array<Vector3, 4>& rest = problem.hinge.rest;
  const double first = triangle_area(rest[0], rest[2], rest[3]),
               second = triangle_area(rest[1], rest[3], rest[2]);
  const double both = first + second, third = problem.density / 3;

  ClothDefinition cloth;
  cloth.masses = {third * first, third * second, third * both, third * both};
  const auto spring = [&rest](int a, int b, double area) {
    return SpringDefinition{
        a, b, (rest[static_cast<std::size_t>(b)] - rest[static_cast<std::size_t>(a)]).norm(), area};
  };
  cloth.springs = {spring(0, 2, first), spring(0, 3, first), spring(1, 2, second),
                   spring(1, 3, second), spring(2, 3, both)};
  cloth.hinges = {hinge_at_rest({0, 1, 2, 3}, as_columns(rest), problem.hinge.theta0)};
  cloth.material = {problem.young,
                    problem.spring_damping,
                    problem.hinge.ke,
                    problem.hinge.kd,
                    problem.hinge.elastic_geometry,
                    problem.hinge.damping_geometry,
                    problem.hinge.damping_factor};
  cloth.gravity = problem.gravity;
  cloth.prescribed = problem.prescribed;
  cloth.external_force = problem.external_force;
  return cloth;
}

std::vector<double> driven_hinge_start(const DrivenHinge& problem) {
  return free_coordinates(driven_hinge(problem),
                          {as_columns(problem.hinge.x), as_columns(problem.hinge.v)});
}

}  // namespace foldproof::oracles
