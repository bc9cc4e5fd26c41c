// Four sticky patches, two of cloth and two of surfaces that move by themselves, with nine bonds of
// nine particles; their targets coded as in the formulas of reference/forces/sticking.h.
#pragma once

#include <Eigen/Geometry>

#include "reference/forces/sticking.h"
#include "verification/tests/reference/forces/force_differences.h"

namespace foldproof::stuck {

constexpr int n = 9;  // particles

inline StickyPatch patch(const std::vector<Triangle>& triangles, double stiffness,
                         double forecast_time, double far) {
  StickyPatch made;
  made.name = "palm";
  made.triangles = triangles;
  made.stiffness = stiffness;
  made.forecast_time = forecast_time;
  made.near = 0.1;
  made.far = far;
  return made;
}

inline void move_by_itself(StickyPatch& patch, double seed) {
  patch.place = [seed](double t) {
    return PerParticle3(scattered(4, seed) + t * scattered(4, seed + 1.3));
  };
  patch.velocity = [seed](double) { return scattered(4, seed + 1.3); };
}

inline Sticking sticking() {
  Sticking all{{patch({{0, 1, 2}, {2, 1, 3}}, 19, 0.23, 2.6),
                patch({{3, 0, 1}, {1, 0, 2}}, 31, 0.41, 2.1), patch({{3, 2, 0}}, 7, 0, 2.3),
                patch({{2, 3, 1}}, 11, 1, 4.9)}};
  move_by_itself(all.patches[1], 6.1);
  move_by_itself(all.patches[3], 8.4);
  return all;
}

inline State state() {
  State s{0.37, scattered(n, 0.4), scattered(n, 2.9)};
  s.bonds = {{0, 0, 4, Vector3(0.21, 0.34, 0.13)}, {0, 1, 4, Vector3(0.52, -0.11, -0.28)},
             {0, 1, 5, Vector3(0.17, 0.48, 0.31)}, {1, 0, 4, Vector3(0.29, 0.23, -0.19)},
             {1, 0, 6, Vector3(0.11, 0.62, 0.07)}, {1, 1, 6, Vector3(0.41, 0.37, -0.23)},
             {2, 0, 5, Vector3(0.33, 0.27, 0.09)}, {3, 0, 7, Vector3(0.44, 0.19, 0.16)},
             {3, 0, 8, Vector3(-0.12, 0.53, 0.35)}};
  return s;
}

/// Patch, particle, first bond and number of bonds of the seven targets of `state`.
struct Group {
  int patch, particle;
  size_t first, count;
};
inline const std::vector<Group> groups{{0, 4, 0, 2}, {0, 5, 2, 1}, {1, 4, 3, 1}, {1, 6, 4, 2},
                                       {2, 5, 6, 1}, {3, 7, 7, 1}, {3, 8, 8, 1}};

/// The mean of the places of a group's bonds at time t, with the cloth at x.
inline Vector3 target_at(const Sticking& sticking, const Group& group, double t,
                         const PerParticle3& x) {
  const StickyPatch& patch = sticking.patches[size_t(group.patch)];
  const PerParticle3 corners = patch.place ? patch.place(t) : x;
  Vector3 sum = Vector3::Zero();
  for (size_t k = group.first; k < group.first + group.count; ++k) {
    const Bond bond = state().bonds[k];
    const Triangle& names = patch.triangles[size_t(bond.triangle)];
    const Vector3 a = corners.col(names[0]), b = corners.col(names[1]), c = corners.col(names[2]);
    sum += a + bond.place[0] * (b - a) + bond.place[1] * (c - a) +
           bond.place[2] * (b - a).cross(c - a).normalized();
  }
  return sum / double(group.count);
}

inline Vector3 target_velocity(const Sticking& sticking, const Group& group, const State& s) {
  const auto at = [&](double t) { return target_at(sticking, group, t, s.x); };
  const double h = 1e-3;
  return (8 * (at(s.time + h) - at(s.time - h)) - (at(s.time + 2 * h) - at(s.time - 2 * h))) /
         (12 * h);
}

/// How target - particle depends on the cloth: 3 x 3N.
inline Eigen::MatrixXd arm_gradient(const Sticking& sticking, const Group& group, const State& s) {
  return differences(s.x, 1e-3, [&](const PerParticle3& x) {
    return PerParticle3(target_at(sticking, group, s.time, x) - x.col(group.particle));
  });
}

inline double stiffness_of(const StickyPatch& patch, double d) {
  return d < patch.far ? patch.stiffness * std::pow(1 - std::pow(d / patch.far, 2), 2) : 0;
}

/// dk/dd over d.
inline double slope_of(const StickyPatch& patch, double d) {
  const double far2 = patch.far * patch.far;
  return d < patch.far ? -4 * patch.stiffness / far2 * (1 - d * d / far2) : 0;
}

inline PerParticle3 as_forces(const Eigen::VectorXd& list) { return list.reshaped(3, n); }

inline Eigen::MatrixXd matrix_of(const ForceDifferential& K) {
  return foldproof::matrix_of(n, [&](const auto& dx, auto& df) { K.add_product(dx, df); });
}

/// All forces: elastic ones and those of damping at the velocities of s.
inline PerParticle3 forces_of(const Sticking& sticking, const State& s) {
  PerParticle3 f = PerParticle3::Zero(3, n);
  sticking.add_elastic(s, f);
  DampingOperator damping;
  sticking.prepare_damping(s, damping);
  damping.add_product(s.v, f);
  return f;
}

/// The same, but some targets are beyond `far`: that of the third group at 1.5 times it.
inline Sticking out_of_reach() {
  Sticking all = sticking();
  const State s = state();
  const Vector3 arm = target_at(all, groups[2], s.time, s.x) - s.x.col(groups[2].particle);
  all.patches[0].far = 0.3;
  all.patches[1].far = arm.norm() / 1.5;
  return all;
}

}  // namespace foldproof::stuck
