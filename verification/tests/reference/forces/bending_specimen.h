// Hinges of seven particles for tests of bending, and the geometry of one coded as in its drawing.
#pragma once

#include <Eigen/Geometry>

#include "reference/forces/bending.h"
#include "verification/oracles/definitions.h"
#include "verification/tests/reference/forces/force_differences.h"
#include "verification/tests/reference/forces/at_state.h"

namespace foldproof {

constexpr int hinge_particles = 7;

inline State hinge_state() { return {0.37, scattered(hinge_particles, 0.4), scattered(7, 2.9)}; }

/// Five hinges, of which each particle is another corner; the factors and angles at rest have
/// nothing to do with the state.
inline Bending five_hinges(const BendingMaterial& material) {
  Bending bending{material, {}};
  const auto add = [&](const std::array<int, 4>& particles, double weight, double angle) {
    bending.hinges.push_back({particles, weight, angle, std::sin(angle / 2)});
  };
  add({0, 6, 3, 5}, 0.83, 0.63);
  add({6, 2, 1, 4}, 1.27, -1.41);
  add({5, 0, 6, 1}, 0.59, 2.17);
  add({2, 4, 0, 6}, 1.91, -0.29);
  add({1, 3, 5, 0}, 0.71, 1.13);
  return bending;
}

inline std::array<Vector3, 4> corners_of(const BendingHinge& hinge, const PerParticle3& x) {
  const auto& at = hinge.particles;
  return {x.col(at[0]), x.col(at[1]), x.col(at[2]), x.col(at[3])};
}

/// |E| [m], |N1| + |N2| [m^2], and b1, b2 of the drawing in bending.h.
struct HingeNumbers {
  double edge, area_sum;
  std::array<double, 2> b;

  double weight() const { return edge * edge / area_sum; }
};

inline HingeNumbers numbers_of(const std::array<Vector3, 4>& x) {
  const auto& [x1, x2, x3, x4] = x;
  const Vector3 E = x4 - x3;
  return {E.norm(),
          (x1 - x3).cross(x1 - x4).norm() + (x2 - x4).cross(x2 - x3).norm(),
          {(x4 - x1).dot(E) / E.squaredNorm(), (x4 - x2).dot(E) / E.squaredNorm()}};
}

inline double sine_law(double theta, double rest) {
  return std::sin(theta / 2) - std::sin(rest / 2);
}
inline double cubic_law(double theta, double rest) {
  return (theta - rest) / 2 * (1 + std::pow(theta - rest, 2));
}

inline std::array<BendingMaterial, 4> bending_materials() {
  BendingMaterial material;
  material.stiffness = 0.37;
  material.damping = 0.19;
  std::array<BendingMaterial, 4> all;
  all.fill(material);
  all[1].weighting = Weighting::current;
  all[2].law = "cubic";
  all[2].damping_factor = DampingFactor::edge_squared_over_area;
  all[3].law = "cubic";
  all[3].weighting = Weighting::current;
  return all;
}

inline PerParticle3 bending_damping_forces(const Bending& bending, const State& s) {
  DampingOperator damping;
  prepare_damping(bending, s, damping);
  PerParticle3 f = PerParticle3::Zero(3, s.x.cols());
  damping.add_product(s.v, f);
  return f;
}

}  // namespace foldproof
