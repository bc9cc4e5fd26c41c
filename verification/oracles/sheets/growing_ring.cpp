#include "verification/oracles/sheets/growing_ring.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace foldproof::oracles {

namespace {

/// Both ends of an edge, and the corner opposite in each of its triangles.
using Hinges = std::map<std::pair<int, int>, std::vector<int>>;

Hinges hinges_of(const std::vector<std::array<int, 3>>& triangles) {
  Hinges hinges;
  for (const std::array<int, 3>& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3];
      hinges[{std::min(a, b), std::max(a, b)}].push_back(t[(k + 2) % 3]);
    }
  return hinges;
}

/// Factors of the heights of both ends and both opposite corners in the hinge's angle [1/m], from
/// the distances of those corners from the edge.
Eigen::Vector4d small_angle(const PerParticle3& x, const std::array<int, 4>& corners) {
  const Vector3 end = x.col(corners[0]), along = x.col(corners[1]) - end;
  Eigen::Vector4d factors = Eigen::Vector4d::Zero();
  for (const std::size_t k : {2, 3}) {
    const Vector3 out = x.col(corners[k]) - end;
    const double foot = out.dot(along) / along.squaredNorm(), away = (out - foot * along).norm();
    factors[Eigen::Index(k)] = 1 / away;
    factors[0] -= (1 - foot) / away;
    factors[1] -= foot / away;
  }
  return factors;
}

double area(const PerParticle3& x, const std::array<int, 3>& t) {
  const Vector3 a = x.col(t[0]), b = x.col(t[1]), c = x.col(t[2]);
  return (b - a).cross(c - a).norm() / 2;
}

}  // namespace

double GrowingRing::radius(int circle) const {
  return plate * std::exp((circle - 0.5) * std::sqrt(3.0) * pi / around);
}

PerParticle3 GrowingRing::rest() const {
  PerParticle3 rest(3, around * (rows + 2));
  for (int circle = 0; circle <= rows + 1; ++circle)
    for (int i = 0; i < around; ++i) {
      const double angle = 2 * pi * (i + 0.5 * (circle % 2)) / around;
      rest.col(circle * around + i) = radius(circle) * Vector3(std::cos(angle), std::sin(angle), 0);
    }
  return rest;
}

std::vector<std::array<int, 3>> GrowingRing::triangles() const {
  std::vector<std::array<int, 3>> all;
  const auto particle = [&](int circle, int i) { return circle * around + i % around; };
  for (int circle = 0; circle <= rows; ++circle)
    for (int i = 0; i < around; ++i) {
      const int turned = circle % 2;  // the inner circle is half a spacing ahead
      const int in = particle(circle, i), in_next = particle(circle, i + 1);
      const int out = particle(circle + 1, i + turned), out_next = particle(circle + 1, i + 1);
      all.push_back({in, out, in_next});
      if (turned == 0)
        all.push_back({in_next, out, out_next});
      else
        all.push_back({in, particle(circle + 1, i), out});
    }
  return all;
}

double sag_of_hinges(const GrowingRing& ring) {
  const PerParticle3 x = ring.rest();
  const std::vector<std::array<int, 3>> triangles = ring.triangles();
  const Eigen::Index free = x.cols() - ring.held();
  Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(x.cols(), x.cols());
  for (const auto& [ends, opposite] : hinges_of(triangles)) {
    if (opposite.size() < 2) continue;  // a free edge
    const std::array<int, 4> at{ends.first, ends.second, opposite[0], opposite[1]};
    const double both = area(x, {at[0], at[1], at[2]}) + area(x, {at[0], at[1], at[3]});
    const double stored = (x.col(at[1]) - x.col(at[0])).squaredNorm() / (2 * both);
    const Eigen::Vector4d factors = small_angle(x, at);
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < 4; ++j)
        stiffness(at[i], at[j]) += 2 * stored * factors[Eigen::Index(i)] * factors[Eigen::Index(j)];
  }
  Eigen::VectorXd weight = Eigen::VectorXd::Zero(x.cols());
  for (const std::array<int, 3>& t : triangles)
    for (const int corner : t) weight[corner] += area(x, t) / 3;
  const Eigen::VectorXd sag =
      stiffness.bottomRightCorner(free, free).ldlt().solve(weight.tail(free));
  return sag.tail(ring.around).mean() / std::pow(ring.edge(), 4);
}

}  // namespace foldproof::oracles
