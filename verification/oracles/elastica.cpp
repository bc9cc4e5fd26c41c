#include "verification/oracles/elastica.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "reference/types.h"
#include "verification/oracles/collocation.h"
#include "verification/oracles/dense_algebra.h"
#include "verification/oracles/gsl.h"

namespace foldproof::oracles {

namespace {

constexpr double rounding = std::numeric_limits<double>::epsilon();

// ----
// collocation ---------------------------------------------------------------------------------

/// The unknowns: slopes at the nodes, then F_x and F_y.
struct Equations {
  const HeavyStrip& strip;
  const Collocation& nodes;
  Eigen::MatrixXd second = nodes.derivative * nodes.derivative;
  Eigen::RowVectorXd whole = nodes.integral(1);

  /// The residual of the equations, and how it changes with the unknowns.
  std::pair<Eigen::VectorXd, Eigen::MatrixXd> at(const Eigen::VectorXd& unknowns,
                                                 double gamma) const {
    const Eigen::Index n = nodes.s.size() - 1;
    const Eigen::VectorXd theta = unknowns.head(n + 1), cosine = theta.array().cos(),
                          sine = theta.array().sin();
    const double F_x = unknowns[n + 1];
    const Eigen::VectorXd F_y = unknowns[n + 2] - gamma * (1 - nodes.s.array());
    Eigen::VectorXd miss = Eigen::VectorXd::Zero(n + 3);
    Eigen::MatrixXd change = Eigen::MatrixXd::Zero(n + 3, n + 3);
    miss.head(n + 1) = second * theta - F_x * sine + F_y.cwiseProduct(cosine);
    change.topLeftCorner(n + 1, n + 1) = second;
    change.topLeftCorner(n + 1, n + 1).diagonal() -= F_x * cosine + F_y.cwiseProduct(sine);
    change.col(n + 1).head(n + 1) = -sine;
    change.col(n + 2).head(n + 1) = cosine;
    for (const Eigen::Index end : {Eigen::Index(0), n}) change.row(end).setZero();
    miss[0] = theta[0] - strip.first_slope;
    change(0, 0) = 1;
    if (strip.last && strip.last->hold == EndHold::clamped) {
      miss[n] = theta[n] - strip.last->slope;
      change(n, n) = 1;
    } else {
      miss[n] = nodes.derivative.row(n).dot(theta);
      change.row(n).head(n + 1) = nodes.derivative.row(n);
    }
    if (strip.last) {
      miss[n + 1] = whole.dot(cosine) - strip.last->across;
      miss[n + 2] = whole.dot(sine) - strip.last->up;
      change.row(n + 1).head(n + 1) = -whole.cwiseProduct(sine.transpose());
      change.row(n + 2).head(n + 1) = whole.cwiseProduct(cosine.transpose());
    } else {
      miss.tail(2) = unknowns.tail(2);
      change(n + 1, n + 1) = change(n + 2, n + 2) = 1;
    }
    return {miss, change};
  }
};

/// Newton's method at one weight; steps no longer than `longest`, to stay on the branch.
void find_equilibrium(const Equations& equations, double gamma, Eigen::VectorXd& unknowns) {
  constexpr double longest = 0.4;  // rad
  constexpr int most_steps = 60;
  const Eigen::Index slopes = unknowns.size() - 2;
  double before = std::numeric_limits<double>::infinity();
  for (int i = 0; i < most_steps; ++i) {
    const auto [miss, change] = equations.at(unknowns, gamma);
    const Eigen::VectorXd step = solve_linear(change, -miss);
    const double size = step.head(slopes).cwiseAbs().maxCoeff();
    if (!step.allFinite()) break;
    unknowns += (size > longest ? longest / size : 1) * step;
    if (size < 1e-8 && !(size < before / 4)) return;  // rounding is left
    before = size;
  }
  throw std::runtime_error("oracle elastica: no equilibrium found at gamma = " +
                           std::to_string(gamma));
}

/// Weights from zero to the full one: 10, then factors of at most 2.
Eigen::VectorXd equilibrium(const HeavyStrip& strip, const Collocation& nodes) {
  const Equations equations{strip, nodes};
  const double last_slope = strip.last ? strip.last->slope : strip.first_slope;
  Eigen::VectorXd unknowns = Eigen::VectorXd::Zero(nodes.s.size() + 2);
  unknowns.head(nodes.s.size()) = strip.first_slope +
                                  (last_slope - strip.first_slope) * nodes.s.array() +
                                  strip.bulge * (2 * pi * nodes.s.array()).sin();
  find_equilibrium(equations, 0, unknowns);
  for (double gamma = std::min(10.0, strip.gamma); strip.gamma > 0;
       gamma = std::min(2 * gamma, strip.gamma)) {
    find_equilibrium(equations, gamma, unknowns);
    if (gamma >= strip.gamma) break;
  }
  return unknowns;
}

std::vector<StripPoint> points_of(const Collocation& nodes, const Eigen::VectorXd& unknowns,
                                  std::span<const double> arc_lengths) {
  const Eigen::VectorXd theta = unknowns.head(nodes.s.size()), factors = nodes.coefficients * theta,
                        cosine = theta.array().cos(), sine = theta.array().sin();
  std::vector<StripPoint> points;
  for (const double s : arc_lengths) {
    const Eigen::RowVectorXd integral = nodes.integral(s);
    double slope = 0;
    for (Eigen::Index k = 0; k < factors.size(); ++k)
      slope += factors[k] * std::cos(double(k) * std::acos(std::clamp(2 * s - 1, -1.0, 1.0)));
    points.push_back({slope, integral.dot(cosine), integral.dot(sine)});
  }
  return points;
}

double largest_difference(const std::vector<StripPoint>& one, const std::vector<StripPoint>& two) {
  double largest = 0;
  for (std::size_t i = 0; i < one.size(); ++i)
    for (const double difference :
         {one[i].slope - two[i].slope, one[i].across - two[i].across, one[i].up - two[i].up})
      if (!(std::abs(difference) <= largest)) largest = std::abs(difference);
  return largest;
}

void require_known_weight(const HeavyStrip& strip) {
  if (!(strip.gamma >= 0 && strip.gamma <= 1e5))
    throw InputError("oracle elastica: gamma must be in [0, 1e5]");
}

// ----
// shooting ------------------------------------------------------------------------------------

/// Curvature at the first end, then F_x and F_y.
using Aim = std::array<double, 3>;

/// Slope, curvature, and place along the strip, with one aim.
ReferenceSolution shoot(const HeavyStrip& strip, const Aim& aim, std::span<const double> s) {
  const RightHandSide rhs = [&](double at, std::span<const double> y, std::span<double> dy) {
    const double along_x = std::cos(y[0]), along_y = std::sin(y[0]);
    const double pull_y = aim[2] - strip.gamma * (1 - at);
    dy[0] = y[1];
    dy[1] = aim[1] * along_y - pull_y * along_x;
    dy[2] = along_x;
    dy[3] = along_y;
  };
  return reference_solution(rhs, std::array<double, 4>{strip.first_slope, aim[0], 0, 0}, 0, s,
                            1e-13);
}

Eigen::Vector3d miss_of(const StripEnd& end, const ReferenceSolution& shot) {
  const std::vector<double>& y = shot.values.back();
  return {end.hold == EndHold::clamped ? y[0] - end.slope : y[1], y[2] - end.across, y[3] - end.up};
}

/// Shots with each unknown a little larger.
std::array<ReferenceSolution, 3> beside(const HeavyStrip& strip, const Aim& aim, double change,
                                        std::span<const double> s) {
  std::array<ReferenceSolution, 3> shots;
  for (std::size_t k = 0; k < 3; ++k) {
    Aim other = aim;
    other[k] += change;
    shots[k] = shoot(strip, other, s);
  }
  return shots;
}

constexpr double aim_change = 1e-5;

}  // namespace

StripShape strip_by_collocation(const HeavyStrip& strip, std::span<const double> arc_lengths) {
  require_known_weight(strip);
  std::vector<StripPoint> before, points;
  double difference = std::numeric_limits<double>::infinity();
  int n = 48;
  StripShape shape;
  for (; n <= 300 && difference > 1e-11; n += n / 2) {
    const Collocation nodes(n);
    before = std::move(points);
    const Eigen::VectorXd unknowns = equilibrium(strip, nodes);
    points = points_of(nodes, unknowns, arc_lengths);
    shape.first_curvature = nodes.derivative.row(0).dot(unknowns.head(nodes.s.size()));
    shape.force_across = unknowns[nodes.s.size()];
    shape.force_up = unknowns[nodes.s.size() + 1];
    if (!before.empty()) difference = largest_difference(points, before);
  }
  shape.points = std::move(points);
  shape.uncertainty = difference + 64 * n * rounding;
  return shape;
}

StripShape strip_by_shooting(const HeavyStrip& strip, std::span<const double> arc_lengths) {
  require_known_weight(strip);
  if (!strip.last) throw InputError("oracle elastica: shooting needs a strip held at both ends");
  const Collocation nodes(48);
  const Eigen::VectorXd start = equilibrium(strip, nodes);
  const Eigen::Index n = nodes.s.size() - 1;
  Aim aim{nodes.derivative.row(0).dot(start.head(n + 1)), start[n + 1], start[n + 2]};
  std::vector<double> s(arc_lengths.begin(), arc_lengths.end());
  s.push_back(1);

  Eigen::Matrix3d change;
  ReferenceSolution hit;
  std::array<ReferenceSolution, 3> others;
  for (int turn = 0; turn < 6; ++turn) {
    hit = shoot(strip, aim, s);
    others = beside(strip, aim, aim_change, s);
    for (int k = 0; k < 3; ++k)
      change.col(k) =
          (miss_of(*strip.last, others[std::size_t(k)]) - miss_of(*strip.last, hit)) / aim_change;
    const Eigen::VectorXd step = solve_linear(change, -miss_of(*strip.last, hit));
    for (int k = 0; k < 3; ++k) aim[std::size_t(k)] += step[k];
  }
  hit = shoot(strip, aim, s);

  StripShape shape{{}, 0};
  for (std::size_t i = 0; i + 1 < s.size(); ++i)
    shape.points.push_back({hit.values[i][0], hit.values[i][2], hit.values[i][3]});
  // an error of the miss moves the points as much as the aim that corrects it does
  const double off = miss_of(*strip.last, hit).cwiseAbs().maxCoeff() + hit.uncertainty.back();
  shape.uncertainty = hit.uncertainty.back();
  shape.first_curvature = aim[0];
  shape.force_across = aim[1];
  shape.force_up = aim[2];
  const Eigen::Matrix3d rows = change.transpose();
  for (std::size_t k = 0; k < 3; ++k) {
    double moved = 0;
    for (std::size_t i = 0; i < s.size(); ++i)
      for (const std::size_t part : {0, 2, 3})
        moved = std::max(moved, std::abs(others[k].values[i][part] - hit.values[i][part]));
    const Eigen::VectorXd amends = solve_linear(rows, Eigen::Vector3d::Unit(int(k)));
    shape.uncertainty += moved / aim_change * amends.cwiseAbs().sum() * off;
  }
  return shape;
}

}  // namespace foldproof::oracles
