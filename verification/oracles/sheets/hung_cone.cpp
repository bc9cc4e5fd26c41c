#include "verification/oracles/sheets/hung_cone.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>

#include "reference/types.h"
#include "verification/oracles/dense_algebra.h"
#include "verification/oracles/gsl.h"

namespace foldproof::oracles {

namespace {

constexpr int load_steps = 12;  // the weight grows in this many steps; each starts from the last

void require_known(int folds, double weight) {
  if (!(folds >= 2 && folds <= 9 && weight > 0))
    throw InputError("oracle hung_cone: folds must be 2 to 9 and the weight > 0");
}

[[noreturn]] void reject_overhang() {
  throw InputError("oracle hung_cone: the weight makes the folds overhang");
}

/// Under little weight the curve is z = -mean + height cos(folds s).
struct GentleCone {
  double mean, height;
};

GentleCone gentle_cone(int folds, double weight) {
  const double n2 = folds * folds;
  return {weight / n2, weight * 2 * std::sqrt((n2 - 1) / 2) / (n2 * (n2 - 1))};
}

/// Half a wave by terms b_0, ..., b_(terms - 1), at midpoints in s: even in s and periodic, so that
/// their mean converges as the series does.
struct HalfWave {
  int folds, terms;
  double weight;
  double step;                         // of s
  Eigen::MatrixXd value, slope, bend;  // of terms at the midpoints: z, z', z'' + z

  HalfWave(int waves, int number, double load)
      : folds(waves), terms(number), weight(load), step(pi / waves / (6 * number)) {
    value.resize(6 * number, number);
    slope = bend = value;
    for (int i = 0; i < value.rows(); ++i)
      for (int j = 0; j < number; ++j) {
        const double q = j * waves, s = (i + 0.5) * step;
        value(i, j) = std::cos(q * s);
        slope(i, j) = -q * std::sin(q * s);
        bend(i, j) = (1 - q * q) * std::cos(q * s);
      }
  }

  /// The derivative of energy - pull (azimuth - pi/folds), all over half a wave, by the terms and
  /// by the pull; the last unknown is the pull.
  Eigen::VectorXd residual(const Eigen::VectorXd& unknowns) const {
    const Eigen::VectorXd b = unknowns.head(terms);
    const double pull = unknowns[terms];
    const Eigen::ArrayXd z = value * b, dz = slope * b, k = bend * b;
    const Eigen::ArrayXd level = 1 - z * z - dz * dz, width = 1 - z * z;
    if (!(level.minCoeff() > 0)) reject_overhang();
    const Eigen::ArrayXd root = level.sqrt();
    const Eigen::ArrayXd by_z = weight + k.square() / level.square() * z -
                                pull * (2 * z * root / width.square() - z / root / width);
    const Eigen::ArrayXd by_dz = k.square() / level.square() * dz + pull * dz / root / width;
    Eigen::VectorXd all(terms + 1);
    all.head(terms) =
        step * (value.transpose() * by_z.matrix() + slope.transpose() * by_dz.matrix() +
                bend.transpose() * (k / level).matrix());
    all[terms] = step * (root / width).sum() - pi / folds;
    return all;
  }

  double energy(const Eigen::VectorXd& b) const {
    const Eigen::ArrayXd z = value * b, dz = slope * b, k = bend * b;
    return 2 * folds * step * (k.square() / (1 - z * z - dz * dz) / 2 + weight * z).sum();
  }
};

/// Newton's method with derivatives by central differences; the size of the last step.
template <class Residual>
double solve_by_newton(const Residual& residual, Eigen::VectorXd& x) {
  double last = 1;
  for (int turn = 0; turn < 40 && last > 1e-12; ++turn) {
    const Eigen::VectorXd off = residual(x);
    Eigen::MatrixXd derivative(off.size(), x.size());
    constexpr double change = 1e-6;
    for (int j = 0; j < x.size(); ++j) {
      Eigen::VectorXd more = x, less = x;
      more[j] += change;
      less[j] -= change;
      derivative.col(j) = (residual(more) - residual(less)) / (2 * change);
    }
    const Eigen::VectorXd step = solve_linear(derivative, -off);
    last = step.cwiseAbs().maxCoeff();
    x += std::min(1.0, 0.3 / last) * step;
  }
  return last;
}

/// The terms, and their distance from the solution.
std::pair<Eigen::VectorXd, double> terms_of(int folds, double weight, int terms) {
  const GentleCone gentle = gentle_cone(folds, weight / load_steps);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(terms + 1);
  x[0] = -gentle.mean;
  x[1] = gentle.height;
  double last = 0;
  for (int i = 1; i <= load_steps; ++i) {
    const HalfWave half(folds, terms, weight * i / load_steps);
    last = solve_by_newton([&](const Eigen::VectorXd& at) { return half.residual(at); }, x);
  }
  return {x.head(terms), last};
}

/// Point, tangent, curvature and its slope, azimuth, energy, sum of heights.
using AlongCurve = std::array<double, 11>;

ReferenceSolution curve_from_crest(const Eigen::VectorXd& unknowns, double weight,
                                   std::span<const double> arc_lengths) {
  const double z = unknowns[0], mu = unknowns[2];
  const RightHandSide rhs = [weight, mu](double, std::span<const double> y, std::span<double> dy) {
    const Eigen::Vector3d point(y[0], y[1], y[2]), tangent(y[3], y[4], y[5]);
    const Eigen::Vector3d normal = point.cross(tangent);
    const Eigen::Vector3d turn = -point + y[6] * normal;
    for (int i = 0; i < 3; ++i) {
      dy[std::size_t(i)] = tangent[i];
      dy[std::size_t(i + 3)] = turn[i];
    }
    dy[6] = y[7];
    dy[7] = -y[6] * y[6] * y[6] / 2 - y[6] * (1 - mu - weight * y[2]) - weight * normal.z();
    dy[8] = (y[0] * y[4] - y[1] * y[3]) / (1 - y[2] * y[2]);
    dy[9] = y[6] * y[6] / 2 + weight * y[2];
    dy[10] = y[2];
  };
  const AlongCurve start{std::sqrt(1 - z * z), 0, z, 0, 1, 0, unknowns[1], 0, 0, 0, 0};
  return reference_solution(rhs, start, 0, arc_lengths, 1e-12);
}

/// Folds the arc length into half a wave from a crest.
double in_half_wave(int folds, double s) {
  const double wave = 2 * pi / folds, within = s - wave * std::floor(s / wave);
  return std::min(within, wave - within);
}

}  // namespace

HungCone hung_cone_by_series(int folds, double weight, std::span<const double> arc_lengths) {
  require_known(folds, weight);
  constexpr int terms = 16;
  const auto [b, last] = terms_of(folds, weight, terms);
  const auto [fewer, same] = terms_of(folds, weight, terms - 5);
  const HalfWave half(folds, terms, weight), coarse(folds, terms - 5, weight);
  const double energy = half.energy(b);
  const double off = (b.head(terms - 5) - fewer).cwiseAbs().sum() + b.tail(5).cwiseAbs().sum() +
                     last + same + 1e-12;
  HungCone cone;
  cone.energy = {energy, std::abs(energy - coarse.energy(fewer)) + 1e-11 * std::abs(energy)};
  cone.depth = {-b[0], off};
  cone.uncertainty = off;
  for (const double s : arc_lengths) {
    double z = 0;
    for (int j = 0; j < terms; ++j) z += b[j] * std::cos(j * folds * s);
    cone.heights.push_back(z);
  }
  return cone;
}

HungCone hung_cone_by_shooting(int folds, double weight, std::span<const double> arc_lengths) {
  require_known(folds, weight);
  const double n2 = folds * folds;
  const GentleCone gentle = gentle_cone(folds, weight / load_steps);
  // height and curvature of the crest, and mu
  Eigen::VectorXd unknowns(3);
  unknowns << gentle.height - gentle.mean, (1 - n2) * gentle.height - gentle.mean, 1 - n2;
  const std::array<double, 1> trough{pi / folds};
  double last = 0;
  for (int i = 1; i <= load_steps; ++i)
    last = solve_by_newton(
        [&](const Eigen::VectorXd& at) {
          const std::vector<double> y =
              curve_from_crest(at, weight * i / load_steps, trough).values[0];
          return Eigen::VectorXd(Eigen::Vector3d(y[5], y[7], y[8] - pi / folds));
        },
        unknowns);
  const ReferenceSolution end = curve_from_crest(unknowns, weight, trough);
  const double off = 100 * (last + end.uncertainty[0]);
  HungCone cone;
  cone.energy = {2 * folds * end.values[0][9], 2 * folds * off};
  cone.depth = {-end.values[0][10] * folds / pi, off};
  cone.uncertainty = off;
  for (const double s : arc_lengths) {
    const std::array<double, 1> at{in_half_wave(folds, s)};
    cone.heights.push_back(at[0] > 0 ? curve_from_crest(unknowns, weight, at).values[0][2]
                                     : unknowns[0]);
  }
  return cone;
}

}  // namespace foldproof::oracles
