// Four particles under a nonlinear, time-dependent force and damping, written as dense matrices: a
// step of any method can be worked out from its formula. Particle 2 is prescribed.
#pragma once

#include <Eigen/Dense>

#include "reference/dynamics/system.h"

namespace foldproof {

inline Eigen::VectorXd flat(const PerParticle3& a) {
  return Eigen::Map<const Eigen::VectorXd>(a.data(), a.size());
}

inline PerParticle3 columns(const Eigen::VectorXd& a) {
  return Eigen::Map<const PerParticle3>(a.data(), 3, a.size() / 3);
}

/// A full matrix without symmetry, entries of order `size`.
inline Eigen::MatrixXd uneven_matrix(int n, double size, double phase) {
  Eigen::MatrixXd a(n, n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) a(i, j) = size * std::sin(1.7 * i * i + 0.9 * j + phase);
  return a;
}

/// Positive definite, full.
inline Eigen::MatrixXd uneven_definite_matrix(int n, double size, double phase) {
  const Eigen::MatrixXd a = uneven_matrix(n, 1, phase);
  return size * (a * a.transpose() / n + 0.3 * Eigen::MatrixXd::Identity(n, n));
}

/// F = -K (x - rest) - cubic (x - rest)^3 + load sin(3 t), D = -(1 + 0.4 sin(x_0) + 0.3 t) C.
struct DynamicsSpecimen {
  static constexpr int count = 4, prescribed = 2;
  Eigen::MatrixXd K = uneven_definite_matrix(12, 7.3, 0.4),
                  C = uneven_definite_matrix(12, 1.9, 2.6);
  double cubic = 3.1;
  PerParticle3 rest, load;
  Motion motion;
  System system;
  State now;

  DynamicsSpecimen() {
    rest = columns(uneven_matrix(12, 0.2, 5.1).col(3));
    load = columns(uneven_matrix(12, 0.7, 1.3).col(7));
    now.time = 0.7;
    now.x = columns(uneven_matrix(12, 0.9, 0.2).col(4));
    now.v = columns(uneven_matrix(12, 1.3, 3.9).col(8));
    now.bonds = {{5, 3, 1, Vector3(0.2, 0.4, 0.6)}};
    motion.velocity = {0.3, -0.4, 0.5};
    motion.amplitude = {0.11, 0.07, -0.13};
    motion.frequency = 0.6;
    motion.phase = 0.8;
    motion.angular_velocity = {0.5, 0.9, -0.7};
    motion.center = {0.4, 0.3, -0.2};

    system = make_system((PerParticle(4) << 0.31, 0.47, 0.23, 0.59).finished());
    system.solver.tolerance = 1e-14;
    CustomForce force;
    force.elastic = [this](const State& s, PerParticle3& f) {
      f += columns(elastic(s.time, flat(s.x)));
    };
    force.damping = [this](const State& s, const PerParticle3& v, PerParticle3& f) {
      f += columns(damping(s.time, flat(s.x)) * flat(v));
    };
    force.differential = [this](const State& s, const PerParticle3& dx, PerParticle3& df) {
      df += columns(stiffness(flat(s.x)) * flat(dx));
    };
    system.forces.emplace_back(std::move(force));
    const Vector3 start(0.6, -0.3, 0.8);
    now.x.col(prescribed) = position_at(motion, start, now.time);
    now.v.col(prescribed) = velocity_at(motion, start, now.time);
    prescribe(system, {prescribed, start, motion});
  }
  DynamicsSpecimen(const DynamicsSpecimen&) = delete;

  Eigen::VectorXd elastic(double t, const Eigen::VectorXd& x) const {
    const Eigen::VectorXd d = x - flat(rest);
    return -K * d - cubic * d.array().cube().matrix() + std::sin(3 * t) * flat(load);
  }
  Eigen::MatrixXd damping(double t, const Eigen::VectorXd& x) const {
    return -(1 + 0.4 * std::sin(x[0]) + 0.3 * t) * C;
  }
  /// The derivative of `elastic`.
  Eigen::MatrixXd stiffness(const Eigen::VectorXd& x) const {
    const Eigen::VectorXd d = x - flat(rest);
    return -K - 3 * cubic * Eigen::MatrixXd(d.array().square().matrix().asDiagonal());
  }
  Eigen::VectorXd mass() const {
    return flat(PerParticle3(system.mass.transpose().replicate(3, 1)));
  }

  Vector3 path(double t) const { return position_at(motion, system.prescribed[0].start, t); }
  Vector3 path_velocity(double t) const {
    return velocity_at(motion, system.prescribed[0].start, t);
  }
  /// The same with the prescribed particle's entries replaced.
  Eigen::VectorXd with(Eigen::VectorXd a, const Vector3& prescribed_entries) const {
    a.segment<3>(3 * prescribed) = prescribed_entries;
    return a;
  }

  /// The w of A w = b at free particles that is `known` at the prescribed one.
  Eigen::VectorXd solve(Eigen::MatrixXd A, Eigen::VectorXd b, const Vector3& known) const {
    for (int i = 3 * prescribed; i < 3 * prescribed + 3; ++i)
      A.row(i) = Eigen::VectorXd::Unit(A.cols(), i);
    return A.partialPivLu().solve(with(std::move(b), known));
  }
};

/// Corrects free particles by amounts that depend on everything a filter is given.
inline CustomFilter uneven_filter(int prescribed) {
  return {[prescribed](const Span& span, const State& s, PerParticle3& v) {
    for (int i = 0; i < v.cols(); ++i) {
      if (i == prescribed) continue;
      const Vector3 push(0.31 * span.start, 0.17 * span.end - 0.09 * span.start, 2.3 * span.step);
      v.col(i) = 0.8 * v.col(i) + push + 0.12 * s.x.col(i) + 0.07 * s.v.col(i) +
                 Vector3::Constant(0.05 * s.time);
    }
  }};
}

}  // namespace foldproof
