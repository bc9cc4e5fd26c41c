#include "verification/oracles/folds.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "reference/types.h"
#include "verification/oracles/collocation.h"
#include "verification/oracles/dense_algebra.h"
#include "verification/oracles/gsl.h"

namespace foldproof::oracles {

namespace {

/// The highest value of a parabola through three values at neighbouring places.
double top_of_parabola(double before, double top, double after) {
  const double slope = (after - before) / 2, bend = before - 2 * top + after;
  return bend == 0 ? top : top - slope * slope / (2 * bend);
}

Estimate highest(const StripShape& shape) {
  const auto is_lower = [](const StripPoint& a, const StripPoint& b) { return a.up < b.up; };
  const auto top = std::max_element(shape.points.begin() + 1, shape.points.end() - 1, is_lower);
  return {top_of_parabola((top - 1)->up, top->up, (top + 1)->up), shape.uncertainty};
}

// ---- the free fold

constexpr int even_steps = 2000;

double highest_of(const std::vector<StripPoint>& points) {
  const StripShape shape{points, 0};
  return highest(shape).value;
}

/// Slopes at the nodes, then V and the length: theta'' = l^2 (V - l s) cos(theta) with s over l.
Eigen::VectorXd free_fold_at_nodes(const Collocation& nodes) {
  const Eigen::Index n = nodes.s.size() - 1;
  const Eigen::MatrixXd second = nodes.derivative * nodes.derivative;
  // a hand-drawn start; others may converge to strips that curl once more
  Eigen::VectorXd unknowns(n + 3);
  unknowns << pi * nodes.s.array() + 1.6 * (pi * nodes.s.array()).sin(), 3.5, 4.5;
  for (int turn = 0; turn < 30; ++turn) {
    const Eigen::VectorXd theta = unknowns.head(n + 1), cosine = theta.array().cos(),
                          sine = theta.array().sin();
    const double V = unknowns[n + 1], l = unknowns[n + 2];
    const Eigen::VectorXd push = V - l * nodes.s.array();
    Eigen::VectorXd miss(n + 3);
    Eigen::MatrixXd change = Eigen::MatrixXd::Zero(n + 3, n + 3);
    miss.head(n + 1) = second * theta - l * l * push.cwiseProduct(cosine);
    change.topLeftCorner(n + 1, n + 1) = second;
    change.topLeftCorner(n + 1, n + 1).diagonal() += l * l * push.cwiseProduct(sine);
    change.col(n + 1).head(n + 1) = -l * l * cosine;
    change.col(n + 2).head(n + 1) = -(2 * l * V - 3 * l * l * nodes.s.array()) * cosine.array();
    // the ends: slopes instead of the equation there, then curvatures
    for (const Eigen::Index end : {Eigen::Index(0), n}) {
      change.row(end).setZero();
      change(end, end) = 1;
      miss[end] = theta[end] - (end == 0 ? 0 : pi);
      const Eigen::Index row = n + (end == 0 ? 1 : 2);
      miss[row] = nodes.derivative.row(end).dot(theta);
      change.row(row).head(n + 1) = nodes.derivative.row(end);
    }
    const Eigen::VectorXd step = solve_linear(change, -miss);
    unknowns += std::min(1.0, 0.4 / step.cwiseAbs().maxCoeff()) * step;
  }
  return unknowns;
}

FreeFold collocated(int degree) {
  const Collocation nodes(degree);
  const Eigen::VectorXd unknowns = free_fold_at_nodes(nodes);
  const Eigen::VectorXd theta = unknowns.head(degree + 1), factors = nodes.coefficients * theta,
                        cosine = theta.array().cos(), sine = theta.array().sin();
  const double l = unknowns[degree + 2];
  FreeFold fold{{unknowns[degree + 1], 0}, {l, 0}, {}, {}};
  for (int i = 0; i <= even_steps; ++i) {
    const double s = double(i) / even_steps;
    const Eigen::RowVectorXd integral = l * nodes.integral(s);
    double slope = 0;
    for (Eigen::Index k = 0; k < factors.size(); ++k)
      slope += factors[k] * std::cos(double(k) * std::acos(std::clamp(2 * s - 1, -1.0, 1.0)));
    fold.points.push_back({slope, integral.dot(cosine), integral.dot(sine)});
  }
  fold.height.value = highest_of(fold.points);
  return fold;
}

/// Slope, curvature and place along the lifted part.
ReferenceSolution lifted_by_shooting(double V, std::span<const double> s) {
  const RightHandSide rhs = [V](double at, std::span<const double> y, std::span<double> dy) {
    dy[0] = y[1];
    dy[1] = (V - at) * std::cos(y[0]);
    dy[2] = std::cos(y[0]);
    dy[3] = std::sin(y[0]);
  };
  return reference_solution(rhs, std::array<double, 4>{0, 0, 0, 0}, 0, s, 1e-13);
}

}  // namespace

FreeFold free_fold_by_collocation() {
  const FreeFold coarse = collocated(48);
  FreeFold fold = collocated(72);
  const auto compare = [](Estimate& fine, const Estimate& other) {
    fine.uncertainty = std::abs(fine.value - other.value) + 1e-11;
  };
  compare(fold.push, coarse.push);
  compare(fold.lifted, coarse.lifted);
  compare(fold.height, coarse.height);
  return fold;
}

FreeFold free_fold_by_shooting() {
  double V = 3.7, lifted = 4.7, last_step = 1;  // of a fold drawn by hand
  for (int turn = 0; turn < 12; ++turn) {
    constexpr double change = 1e-5;
    const std::array<double, 1> end{lifted};
    const std::vector<double> y = lifted_by_shooting(V, end).values[0],
                              beside = lifted_by_shooting(V + change, end).values[0];
    Eigen::Matrix2d derivative;  // of slope and curvature at the end, by V and the length
    derivative << (beside[0] - y[0]) / change, y[1], (beside[1] - y[1]) / change,
        (V - lifted) * std::cos(y[0]);
    const Eigen::VectorXd step = solve_linear(derivative, Eigen::Vector2d(pi - y[0], -y[1]));
    V += step[0];
    lifted += step[1];
    last_step = step.cwiseAbs().maxCoeff();
  }
  std::vector<double> even;
  for (int i = 0; i <= even_steps; ++i) even.push_back(lifted * i / even_steps);
  const ReferenceSolution whole = lifted_by_shooting(V, even);
  // an error of the end moves V, the length and the height by a few times as much
  const double off = 10 * (last_step + whole.uncertainty.back());
  FreeFold fold{{V, off}, {lifted, off}, {0, off}, {}};
  for (const std::vector<double>& y : whole.values) fold.points.push_back({y[0], y[2], y[3]});
  fold.height.value = highest_of(fold.points);
  return fold;
}

HeavyStrip lifted_part(const HeavyStrip& strip, double lift_off) {
  const double share = 1 - lift_off;
  HeavyStrip part = strip;
  part.gamma *= share * share * share;
  part.last->across = (part.last->across - lift_off) / share;
  part.last->up /= share;
  return part;
}

Fold fold_on_floor(const HeavyStrip& strip, double least, double most, const StripSolver& solver) {
  if (!strip.last || strip.first_slope != 0)
    throw InputError(
        "oracle folds: the strip must lie level at its first end, and have its last held");
  const std::vector<double> ends{1};
  const auto curvature = [&](double lift_off) {
    return solver(lifted_part(strip, lift_off), ends).first_curvature;
  };
  constexpr double width = 1e-10;
  Fold fold{bracketed_root(curvature, least, most, width), {}};
  std::vector<double> even;
  for (int i = 0; i <= 2000; ++i) even.push_back(i / 2000.0);
  const double share = 1 - fold.lift_off.value;
  const Estimate top = highest(solver(lifted_part(strip, fold.lift_off.value), even));
  // an error of the lift-off moves the top by at most a few times as much; the parabola errs by the
  // fourth power of the points' distance
  fold.lift_off.uncertainty += top.uncertainty;
  fold.height = {share * top.value, top.uncertainty + 4 * fold.lift_off.uncertainty + 1e-12};
  return fold;
}

}  // namespace foldproof::oracles
