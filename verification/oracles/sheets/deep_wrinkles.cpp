#include "verification/oracles/sheets/deep_wrinkles.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>

#include "reference/types.h"
#include "verification/oracles/dense_algebra.h"
#include "verification/oracles/gsl.h"

namespace foldproof::oracles {

namespace {

void require_known(const DeepWrinkles& wrinkles) {
  if (!(wrinkles.reach >= 0.003 && wrinkles.wavelength > 0 && wrinkles.compression > 0))
    throw InputError("oracle deep_wrinkles: the reach must be at least 0.003, the others positive");
}

/// With D = reach^2, K = k^2 and N = compression:
///   D (f'''' - 2 K f'' + K^2 f) - f'' - K N (1 - f^2) f = 0,  f = f' = 0 at both ends.
/// Terms 1 - cos(2 pi j s) at midpoints between a clamp and the middle: even about both, so that
/// their mean converges as the series does.
struct Terms {
  double D, K;
  Eigen::MatrixXd value, linear;  // at the midpoints; the derivative of the linear part's energy

  Terms(const DeepWrinkles& wrinkles, int count)
      : D(wrinkles.reach * wrinkles.reach), K(std::pow(2 * pi / wrinkles.wavelength, 2)) {
    value.resize(4 * count, count);
    for (int i = 0; i < value.rows(); ++i)
      for (int j = 0; j < count; ++j)
        value(i, j) = 1 - std::cos(2 * pi * (j + 1) * (i + 0.5) / double(2 * value.rows()));
    linear = D * K * K * (value.transpose() * value) / double(value.rows());
    for (int j = 0; j < count; ++j) {
      const double q2 = std::pow(2 * pi * (j + 1), 2);
      linear(j, j) += (D * q2 * q2 + (1 + 2 * D * K) * q2) / 2;
    }
  }

  /// Newton's method from c; the size of the last step.
  double solve(double N, Eigen::VectorXd& c) const {
    double last = 1;
    for (int turn = 0; turn < 60 && last > 1e-13; ++turn) {
      const Eigen::ArrayXd f = value * c;
      const double points = double(value.rows());
      const Eigen::VectorXd off =
          linear * c - K * N * (value.transpose() * ((1 - f * f) * f / points).matrix());
      const Eigen::MatrixXd derivative =
          linear -
          K * N * (value.transpose() * ((1 - 3 * f * f) / points).matrix().asDiagonal() * value);
      const Eigen::VectorXd step = solve_linear(derivative, -off);
      last = step.cwiseAbs().maxCoeff();
      c += std::min(1.0, 0.2 / last) * step;
    }
    return last;
  }
};

/// The load doubles up to N, starting where the heights are those of a sine.
Eigen::VectorXd followed(const Terms& terms, double N) {
  const double q2 = pi * pi;
  const double onset = (terms.D * std::pow(q2 + terms.K, 2) + q2) / terms.K;  // of a sine
  double load = N;
  while (load > 3 * onset) load /= 2;
  Eigen::VectorXd c(terms.value.cols());
  const double height = std::sqrt(std::max(4.0 / 3 * (1 - onset / load), 0.01));
  for (int j = 1; j <= int(c.size()); ++j) c[j - 1] = height * 4 / pi / (4.0 * j * j - 1);
  for (; load < 1.5 * N; load *= 2) terms.solve(load, c);
  return c;
}

double middle_of(const Eigen::VectorXd& c) {
  double f = 0;
  for (int j = 1; j <= int(c.size()); j += 2) f += 2 * c[j - 1];
  return f;
}

double bend_of(const Eigen::VectorXd& c) {
  double bend = 0;
  for (int j = 1; j <= int(c.size()); ++j)
    bend += c[j - 1] * std::pow(2 * pi * j, 2) * (j % 2 == 0 ? 1 : -1);
  return bend;
}

/// f and f' at a clamp, for given f and f'' in the middle.
std::array<double, 2> at_clamp(const DeepWrinkles& wrinkles, double middle, double bend) {
  const double D = wrinkles.reach * wrinkles.reach, K = std::pow(2 * pi / wrinkles.wavelength, 2);
  const RightHandSide rhs = [&](double, std::span<const double> y, std::span<double> dy) {
    const double f = y[0];
    for (std::size_t i = 0; i < 3; ++i) dy[i] = y[i + 1];
    dy[3] = 2 * K * y[2] - K * K * f + (y[2] + K * wrinkles.compression * (1 - f * f) * f) / D;
  };
  const std::array<double, 4> start{middle, 0, bend, 0};
  const std::array<double, 1> times{0.5};
  const auto solution = reference_solution(rhs, start, 0, times, 1e-13);
  return {solution.values[0][0], solution.values[0][1]};
}

}  // namespace

DeepWrinkleHeight deep_wrinkles_by_series(const DeepWrinkles& wrinkles,
                                          std::span<const double> places) {
  require_known(wrinkles);
  constexpr int count = 96;
  const Eigen::VectorXd fewer = followed(Terms(wrinkles, count / 2), wrinkles.compression);
  Eigen::VectorXd c = Eigen::VectorXd::Zero(count);
  c.head(fewer.size()) = fewer;
  const double last = Terms(wrinkles, count).solve(wrinkles.compression, c);
  DeepWrinkleHeight result;
  const double middle = middle_of(c);
  if (!(middle > 0.05)) throw InputError("oracle deep_wrinkles: this plate stays flat");
  // errors fall at least with the square of the number of terms
  result.middle = {middle, std::abs(middle - middle_of(fewer)) / 3 + count * last};
  result.bend = bend_of(c);
  for (const double s : places) {
    double f = 0;
    for (int j = 1; j <= count; ++j) f += c[j - 1] * (1 - std::cos(2 * pi * j * s));
    result.heights.push_back(f);
  }
  return result;
}

Estimate deep_wrinkles_by_shooting(const DeepWrinkles& wrinkles, const DeepWrinkleHeight& guess) {
  require_known(wrinkles);
  if (!(wrinkles.reach >= 0.08))
    throw InputError("oracle deep_wrinkles: shooting needs a reach of at least 0.08");
  double f = guess.middle.value, bend = guess.bend, last = 1;
  for (int turn = 0; turn < 20 && last > 1e-11; ++turn) {
    const double change = 1e-7;
    const auto off = at_clamp(wrinkles, f, bend), by_f = at_clamp(wrinkles, f + change, bend),
               by_bend = at_clamp(wrinkles, f, bend + change);
    Eigen::Matrix2d derivative;
    derivative << by_f[0] - off[0], by_bend[0] - off[0], by_f[1] - off[1], by_bend[1] - off[1];
    const Eigen::Vector2d step =
        -change * solve_linear(derivative, Eigen::Vector2d(off[0], off[1]));
    f += step[0];
    bend += step[1];
    last = step.cwiseAbs().maxCoeff();
  }
  return {f, last + 1e-9};
}

}  // namespace foldproof::oracles
