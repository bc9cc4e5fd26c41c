#include "verification/specimens/dense_steps.h"

#include <cmath>
#include <stdexcept>

#include "verification/oracles/dense_algebra.h"
#include "verification/specimens/specimens.h"

namespace foldproof {

DenseCloth::DenseCloth(const Subject& subject, const Scene& scene)
    : scene_(scene), probe_(subject, scene), mass_(3 * scene.mesh.particles()) {
  const PerParticle mass = lumped_masses(scene.mesh, scene.density);
  std::vector<char> held(size_t(scene.mesh.particles()), 0);
  for (const PrescribedParticle& p : scene.prescribed) held[size_t(p.particle)] = 1;
  for (Eigen::Index k = 0; k < mass_.size(); ++k) {
    mass_[k] = mass[k / 3];
    if (!held[size_t(k / 3)]) free_.push_back(k);
  }
}

Eigen::VectorXd DenseCloth::forces(const PerParticle3& x, const PerParticle3& v) const {
  State s = resting_state(x);
  PerParticle3 force = probe_.elastic(s);
  if (scene_.stretch && scene_.stretch->damping > 0) force += probe_.damping(s, v);
  return Eigen::VectorXd(force.reshaped())(free_);
}

/// Derivative of all forces by positions at fixed velocities, for the free coordinates.
Eigen::MatrixXd DenseCloth::stiffness(const State& s, const PerParticle3& v) const {
  constexpr double shift = 1e-7;  // m
  const Eigen::Index n = Eigen::Index(free_.size());
  Eigen::MatrixXd K(n, n);
  for (Eigen::Index j = 0; j < n; ++j) {
    PerParticle3 ahead = s.x, behind = s.x;
    ahead.reshaped()[free_[size_t(j)]] += shift;
    behind.reshaped()[free_[size_t(j)]] -= shift;
    K.col(j) = (forces(ahead, v) - forces(behind, v)) / (2 * shift);
  }
  return K;
}

//   damping force on b: -k (n.w) n, with n the unit direction from a to b, w = v_b - v_a, l = |d|;
//   its derivative by d: -k/l (n (P w)^T + (n.w) P), P = I - n n^T: the first term is unsymmetric
Eigen::MatrixXd DenseCloth::asymmetric_term(const State& s) const {
  const Eigen::VectorXd lengths = rest_lengths(scene_.mesh), areas = edge_areas(scene_.mesh);
  Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(s.x.size(), s.x.size());
  for (size_t e = 0; e < scene_.mesh.edges.size(); ++e) {
    const Edge& edge = scene_.mesh.edges[e];
    const Eigen::Index a = 3 * edge.a, b = 3 * edge.b, k = Eigen::Index(e);
    const double coefficient = scene_.stretch->damping * areas[k] / (lengths[k] * lengths[k]);
    const Vector3 d = s.x.col(edge.b) - s.x.col(edge.a), w = s.v.col(edge.b) - s.v.col(edge.a);
    const double l = d.norm();
    const Vector3 n = d / l, across = w - n.dot(w) * n;
    const Eigen::Matrix3d block = -coefficient / l * n * across.transpose();
    whole.block<3, 3>(b, b) += block;
    whole.block<3, 3>(a, a) += block;
    whole.block<3, 3>(a, b) -= block;
    whole.block<3, 3>(b, a) -= block;
  }
  return whole(free_, free_);
}

State DenseCloth::average_acceleration(const State& s, double h) {
  const Eigen::VectorXd mass = mass_(free_), before = forces(s.x, s.v),
                        v = Eigen::VectorXd(s.v.reshaped())(free_);
  const auto at = [&](const Eigen::VectorXd& w) {
    State next = s;
    next.time += h;
    PerParticle3 change = PerParticle3::Zero(3, s.x.cols());
    change.reshaped()(free_) = w - v;
    next.v += change;
    next.x += h / 2 * (s.v + next.v);
    return next;
  };
  Eigen::VectorXd w = v;
  for (int turn = 0; turn < 60; ++turn) {
    const State next = at(w);
    const Eigen::VectorXd miss =
        h / 2 * (before + forces(next.x, next.v)) - mass.cwiseProduct(w - v);
    if (inverse_.size() == 0 || turn % 12 == 11) {
      const Eigen::MatrixXd A =
          Eigen::MatrixXd(mass.asDiagonal()) - h * h / 4 * stiffness(next, next.v);
      inverse_ = oracles::solve_symmetric(A, Eigen::MatrixXd::Identity(A.rows(), A.cols()));
    }
    const Eigen::VectorXd step = inverse_ * miss;
    w += step;
    if (step.norm() < 1e-12 * (1 + w.norm())) return at(w);
  }
  throw std::runtime_error("average_acceleration: Newton's method does not converge");
}

State DenseCloth::one_solve(const State& s, double h, DampingDerivative part) const {
  const Eigen::VectorXd mass = mass_(free_), v = Eigen::VectorXd(s.v.reshaped())(free_);
  const PerParticle3 still = PerParticle3::Zero(3, s.x.cols());
  Eigen::MatrixXd K = stiffness(s, part == DampingDerivative::none ? still : s.v);
  if (part == DampingDerivative::symmetric_part) K -= asymmetric_term(s);
  const Eigen::MatrixXd D = damping_matrix(probe_, s)(free_, free_);
  const Eigen::MatrixXd A = Eigen::MatrixXd(mass.asDiagonal()) - h * D - h * h * K;
  const Eigen::VectorXd dv = oracles::solve_linear(A, h * (forces(s.x, s.v) + h * (K * v)));
  State next = s;
  next.time += h;
  PerParticle3 change = PerParticle3::Zero(3, s.x.cols());
  change.reshaped()(free_) = dv;
  next.v += change;
  next.x += h * next.v;
  return next;
}

double DenseCloth::energy(const State& s) const {
  const Eigen::VectorXd v = s.v.reshaped();
  return mass_.dot(v.cwiseAbs2()) / 2 + probe_.energy(s);
}

}  // namespace foldproof
