#include "verification/oracles/chains_and_ribbons.h"

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <functional>
#include <limits>

#include "reference/types.h"
#include "verification/oracles/dense_algebra.h"
#include "verification/oracles/gsl.h"

namespace foldproof::oracles {

namespace {

constexpr double rounding = std::numeric_limits<double>::epsilon();

/// A root in extended precision, between two numbers at which f has opposite signs.
long double bisected_root(const std::function<long double(long double)>& f, long double lower,
                          long double upper) {
  const bool rises = f(lower) < 0;
  for (int i = 0; i < 80; ++i) {
    const long double middle = (lower + upper) / 2;
    ((f(middle) < 0) == rises ? lower : upper) = middle;
  }
  return lower;
}

/// phi(t) for the load Q: of phi = sum a_k t^(6 k), a_(k+1) (6 k + 6)(6 k + 5) = -Q^2/4 a_k.
long double twist_by_series(long double Q, long double t) {
  const long double t_6 = t * t * t * t * t * t;
  long double term = 1, sum = 1;
  for (int k = 0; k < 60; ++k) {
    term *= -Q * Q / 4 * t_6 / ((6 * k + 6) * (6 * k + 5));
    sum += term;
  }
  return sum;
}

long double tipping_load() {
  return bisected_root([](long double Q) { return twist_by_series(Q, 1); }, 8, 18);
}

/// phi(t) for the load G: of phi = sum a_k t^(3 k), a_(k+1) (3 k + 3)(3 k + 2) = -G a_k. Each term
/// of its integral from 0 to t is t/(3 k + 1) times as large.
struct SlopeSeries {
  long double slope, integral;
};

SlopeSeries slope_by_series(long double G, long double t) {
  long double term = 1, sum = 1, integral = t;
  for (int k = 0; k < 60; ++k) {
    term *= -G * t * t * t / ((3 * k + 3) * (3 * k + 2));
    sum += term;
    integral += term * t / (3 * k + 4);
  }
  return {sum, integral};
}

long double self_buckling_load() {
  return bisected_root([](long double G) { return slope_by_series(G, 1).slope; }, 6, 10);
}

/// J0(u) by its power series; up to u = 15 its terms stay below 2e5.
long double bessel_by_series(long double u) {
  long double term = 1, sum = 1;
  for (int k = 1; k < 80; ++k) {
    term *= -u * u / 4 / ((long double)(k)*k);
    sum += term;
  }
  return sum;
}

double last_value(const RightHandSide& rhs, const std::array<double, 2>& start, double from,
                  double to) {
  return reference_solution(rhs, start, from, std::array<double, 1>{to}, 1e-13).values[0][0];
}

/// The root of y(end; p), where GSL's y' at p is accurate to 1e-12 for slopes of size 1.
Estimate root_of_shots(const std::function<double(double)>& shot, double lower, double upper) {
  Estimate root = bracketed_root(shot, lower, upper, 0);
  const double change = 1e-4,
               slope = (shot(root.value + change) - shot(root.value - change)) / (2 * change);
  root.uncertainty += 1e-11 / std::abs(slope);
  return root;
}

/// Roots of J0 lie about pi apart, the first one near 3 pi/4.
double near_root_of_bessel(int n) { return (n - 0.25) * pi; }

void require_known_mode(int n) {
  if (!(n >= 1 && n <= 5))
    throw InputError("oracle chains_and_ribbons: the mode must be one of 1 to 5");
}

void require_slack(const HungChain& chain) {
  if (!(chain.across > 0 && std::hypot(chain.across, chain.up) < 1))
    throw InputError("oracle chains_and_ribbons: the points must be nearer than the chain is long");
}

/// The horizontal pull over the weight, and the arc length of the chain's lowest point over L.
struct Pulls {
  double H, V;
  double uncertainty;
};

Pulls pulls_by_functions(const HungChain& chain) {
  // sqrt(1 - up^2) = 2 H sinh(across/(2 H)), with w = across/(2 H): sinh(w)/w
  const double ratio = std::sqrt(1 - chain.up * chain.up) / chain.across;
  const Estimate w = bracketed_root([ratio](double at) { return std::sinh(at) / at - ratio; }, 1e-3,
                                    12 + std::log(ratio), 0);
  const double H = chain.across / (2 * w.value);
  const double V = 0.5 - chain.up / 2 / std::tanh(w.value);
  return {H, V, 20 * (w.uncertainty + rounding) * (1 + H)};
}

ReferenceSolution hung_by_shooting(const Pulls& pulls, std::span<const double> s) {
  const RightHandSide rhs = [pulls](double at, std::span<const double>, std::span<double> dy) {
    const double T = std::hypot(pulls.H, at - pulls.V);
    dy[0] = pulls.H / T;
    dy[1] = (at - pulls.V) / T;
  };
  return reference_solution(rhs, std::array<double, 2>{0, 0}, 0, s, 1e-13);
}

}  // namespace

Estimate tipping_load_by_series() { return {double(tipping_load()), 20 * rounding}; }

double tipping_twist(double t) { return double(twist_by_series(tipping_load(), t)); }

Estimate tipping_load_by_shooting() {
  const auto twist = [](double Q) {
    const RightHandSide rhs = [Q](double t, std::span<const double> y, std::span<double> dy) {
      dy[0] = y[1];
      dy[1] = -Q * Q / 4 * std::pow(t, 4) * y[0];
    };
    return last_value(rhs, {1, 0}, 0, 1);
  };
  return root_of_shots(twist, 8, 18);
}

Estimate self_buckling_load_by_series() { return {double(self_buckling_load()), 20 * rounding}; }

Estimate self_buckling_load_by_shooting() {
  const auto slope = [](double G) {
    const RightHandSide rhs = [G](double t, std::span<const double> y, std::span<double> dy) {
      dy[0] = y[1];
      dy[1] = -G * t * y[0];
    };
    return last_value(rhs, {1, 0}, 0, 1);
  };
  return root_of_shots(slope, 6, 10);
}

double self_buckling_slope(double t) {
  const long double G = self_buckling_load();
  return double(slope_by_series(G, t).slope / slope_by_series(G, 1).integral);
}

Estimate chain_frequency_by_series(int n) {
  require_known_mode(n);
  const double near = near_root_of_bessel(n);
  return {double(bisected_root(bessel_by_series, near - 1, near + 1)) / 2, 200 * rounding};
}

Estimate chain_frequency_by_shooting(int n) {
  require_known_mode(n);
  // u y'' + y' + u y = 0, started where y = 1 - u^2/4 + u^4/64 to 1e-16
  constexpr double from = 0.01;
  const RightHandSide rhs = [](double u, std::span<const double> y, std::span<double> dy) {
    dy[0] = y[1];
    dy[1] = -y[0] - y[1] / u;
  };
  const std::array<double, 2> start{1 - from * from / 4 + std::pow(from, 4) / 64,
                                    -from / 2 + std::pow(from, 3) / 16};
  const double near = near_root_of_bessel(n);
  const Estimate root =
      root_of_shots([&](double u) { return last_value(rhs, start, from, u); }, near - 1, near + 1);
  return {root.value / 2, root.uncertainty / 2};
}

Catenary catenary(const HungChain& chain, std::span<const double> arc_lengths) {
  require_slack(chain);
  const Pulls at = pulls_by_functions(chain);
  Catenary shape;
  shape.pull_across = {at.H, at.uncertainty};
  shape.pull_up = {-at.V, at.uncertainty};
  shape.uncertainty = 10 * at.uncertainty;
  for (const double s : arc_lengths)
    shape.points.push_back({at.H * (std::asinh((s - at.V) / at.H) + std::asinh(at.V / at.H)),
                            std::hypot(at.H, s - at.V) - std::hypot(at.H, at.V)});
  return shape;
}

Catenary catenary_by_shooting(const HungChain& chain, std::span<const double> arc_lengths) {
  require_slack(chain);
  const std::array<double, 1> whole{1};
  const auto miss = [&](const Pulls& pulls) {
    const std::vector<double> y = hung_by_shooting(pulls, whole).values[0];
    return Eigen::Vector2d(y[0] - chain.across, y[1] - chain.up);
  };
  Pulls at{0.3, 0.5, 0};
  for (int turn = 0; turn < 30; ++turn) {
    constexpr double change = 1e-6;
    const Eigen::Vector2d off = miss(at);
    Eigen::Matrix2d derivative;
    derivative << (miss({at.H + change, at.V, 0}) - off) / change,
        (miss({at.H, at.V + change, 0}) - off) / change;
    const Eigen::Vector2d step = solve_linear(derivative, -off);
    at.H = std::max(at.H / 2, at.H + step[0]);
    at.V += step[1];
    at.uncertainty = step.cwiseAbs().maxCoeff();
  }
  const ReferenceSolution along = hung_by_shooting(at, arc_lengths);
  Catenary shape;
  for (const std::vector<double>& y : along.values) shape.points.push_back({y[0], y[1]});
  const double off = 10 * (at.uncertainty + along.uncertainty.back());
  shape.pull_across = {at.H, off};
  shape.pull_up = {-at.V, off};
  shape.uncertainty = off;
  return shape;
}

}  // namespace foldproof::oracles
