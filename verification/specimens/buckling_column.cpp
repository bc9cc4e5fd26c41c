#include "verification/specimens/buckling_column.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "verification/oracles/dense_algebra.h"
#include "verification/specimens/random.h"

namespace foldproof {

namespace {

/// a of sin(a)/a = ratio < 1, by Newton's method.
double half_angle(double ratio) {
  double a = std::sqrt(6 * (1 - ratio));
  for (int turn = 0; turn < 40; ++turn) {
    const double sinc = std::sin(a) / a, step = (sinc - ratio) / ((std::cos(a) - sinc) / a);
    a -= step;
    if (!(std::abs(step) > 1e-15)) break;
  }
  return a;
}

/// Below this the arc's force is -12 k_b/L^2 to rounding, and its formula divides zero by zero.
constexpr double nearly_straight = 1e-4;

using Places = Eigen::Matrix2Xd;

/// Forces on all particles, their derivative without the push across springs, and the energy.
struct ColumnForces {
  Places force;
  Eigen::MatrixXd derivative;
  double energy = 0;

  /// A spring between i and j: tension [N], its derivative [N/m], energy [J].
  void add(const Places& x, int i, int j, const std::array<double, 3>& spring) {
    const Eigen::Vector2d d = x.col(j) - x.col(i), n = d.normalized();
    force.col(i) += spring[0] * n;
    force.col(j) -= spring[0] * n;
    energy += spring[2];
    const Eigen::Matrix2d along = n * n.transpose();
    const Eigen::Matrix2d block = spring[1] * along + std::max(spring[0], 0.0) / d.norm() *
                                                          (Eigen::Matrix2d::Identity() - along);
    derivative.block<2, 2>(2 * i, 2 * i) -= block;
    derivative.block<2, 2>(2 * j, 2 * j) -= block;
    derivative.block<2, 2>(2 * i, 2 * j) += block;
    derivative.block<2, 2>(2 * j, 2 * i) += block;
  }
};

ColumnForces forces_at(const BucklingColumn& column, const Places& x) {
  const int n = column.particles;
  ColumnForces all{Places::Zero(2, n), Eigen::MatrixXd::Zero(2 * n, 2 * n)};
  for (int i = 0; i + 1 < n; ++i) {
    const double longer = (x.col(i + 1) - x.col(i)).norm() - column.spacing;
    if (longer > 0)
      all.add(x, i, i + 1, {column.pull * longer, column.pull, column.pull * longer * longer / 2});
  }
  for (int i = 0; i + 2 < n; ++i) {
    const double distance = (x.col(i + 2) - x.col(i)).norm();
    const BucklingSpring& spring = column.spring;
    if (distance < spring.length)
      all.add(x, i, i + 2,
              {spring.force(distance), spring.stiffness(distance), spring.energy(distance)});
  }
  return all;
}

struct ColumnState {
  Places x, v;
};

/// Shift of the last two particles at time t, and its rate: smooth, over 0.05 s.
struct Shift {
  double place, velocity;
};
constexpr double duration = 0.05, shortening = 0.2;  // s, fraction of the length

Shift shift_at(const BucklingColumn& column, double t) {
  const double way = -shortening * column.spacing * (column.particles - 1);
  const double part = std::min(t / duration, 1.0);
  return {way * part * part * (3 - 2 * part), way * 6 * part * (1 - part) / duration};
}

/// M (w - V) = s (F + K (X + s w - x)) with known end velocities; X + s w is the next state.
ColumnState step_to(const BucklingColumn& column, const ColumnState& now, const ColumnState& stage,
                    double s, const Shift& end) {
  const int n = column.particles;
  const ColumnForces at = forces_at(column, now.x);
  Places w = Places::Zero(2, n);
  for (const int i : {0, 1, n - 2, n - 1}) {
    const Eigen::Vector2d place(i * column.spacing + (i > 1 ? end.place : 0), 0);
    w.col(i) = (place - stage.x.col(i)) / s;
  }
  const Places from = stage.x - now.x + s * w;
  const Eigen::VectorXd right = column.mass * (stage.v - w).reshaped() +
                                s * (at.force.reshaped() + at.derivative * from.reshaped());
  const Eigen::Index first = 4, count = 2 * (n - 4);
  const Eigen::MatrixXd A = column.mass * Eigen::MatrixXd::Identity(count, count) -
                            s * s * at.derivative.block(first, first, count, count);
  w.reshaped().segment(first, count) =
      oracles::solve_symmetric(A, right.segment(first, count)).reshaped();
  return {stage.x + s * w, w};
}

}  // namespace

double BucklingSpring::arc_force(double distance) const {
  const double a = half_angle(distance / length), kappa = 2 * a / length;
  if (!(a > nearly_straight)) return -12 * bending / (length * length);
  return bending * kappa * kappa / (std::cos(a) - std::sin(a) / a);
}

double BucklingSpring::arc_energy(double distance) const {
  const double kappa = 2 * half_angle(distance / length) / length;
  return bending * length * kappa * kappa / 2;
}

double BucklingSpring::force(double distance) const {
  if (!(distance < length)) return 0;
  return std::max(arc_force(distance), slope * (distance - length));
}

double BucklingSpring::energy(double distance) const {
  if (!(distance < length)) return 0;
  const double straight = std::max(distance, meeting) - length;
  const double along_line = slope * straight * straight / 2;
  return distance > meeting ? along_line : along_line + arc_energy(distance) - arc_energy(meeting);
}

BucklingSpring make_buckling_spring(double length, double bending, double slope) {
  BucklingSpring spring{length, bending, slope, 0};
  double nearer = 0.1 * length, farther = length;
  for (int turn = 0; turn < 60; ++turn) {
    const double middle = (nearer + farther) / 2;
    (slope * (middle - length) > spring.arc_force(middle) ? farther : nearer) = middle;
  }
  spring.meeting = nearer;
  return spring;
}

double BucklingSpring::stiffness(double distance) const {
  const double change = 1e-7 * length;
  return (force(distance + change) - force(distance - change)) / (2 * change);
}

double BucklingColumn::elastic_limit() const { return std::sqrt(mass / pull); }

Shortening shorten(const BucklingColumn& column, ColumnMethod method, double h, int steps) {
  ColumnState now{Places::Zero(2, column.particles), Places::Zero(2, column.particles)};
  Random random(19);
  for (int i = 0; i < column.particles; ++i) {
    now.x(0, i) = i * column.spacing;
    if (i > 1 && i + 2 < column.particles)
      now.x(1, i) = 1e-3 * column.spacing * random.uniform(-1, 1);
  }
  ColumnState before = now;
  Shortening result{0, 0, 0, 0};
  int after_stop = 0;
  for (int k = 1; k <= steps; ++k) {
    const bool is_two_step = method == ColumnMethod::bdf2 && k > 1;
    const ColumnState stage =
        is_two_step ? ColumnState{(4 * now.x - before.x) / 3, (4 * now.v - before.v) / 3} : now;
    const ColumnState next =
        step_to(column, now, stage, is_two_step ? 2 * h / 3 : h, shift_at(column, k * h));
    before = std::exchange(now, next);
    if (k * h < duration || after_stop++ < 2) continue;  // a two-step method ends two steps later
    const Places v = now.v.middleCols(2, column.particles - 4);
    const double energy = forces_at(column, now.x).energy + column.mass * v.squaredNorm() / 2;
    if (after_stop == 3) result.at_the_stop = energy;
    update_worst(result.largest_after, energy);
    result.at_the_end = energy;
    result.speed = v.colwise().norm().maxCoeff();
  }
  return result;
}

double stiffness_across(const BucklingColumn& column, double strain) {
  // springs push along x: across it, a push -f at the distance d is a stiffness f/d
  const int n = column.particles;
  const double distance = column.spring.length * (1 - strain);
  const double across = column.spring.force(distance) / distance;
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n, n);
  for (int i = 0; i + 2 < n; ++i) {
    K(i, i) += across;
    K(i + 2, i + 2) += across;
    K(i, i + 2) -= across;
    K(i + 2, i) -= across;
  }
  return oracles::symmetric_eigenvalues(K.block(2, 2, n - 4, n - 4))[0];
}

}  // namespace foldproof
