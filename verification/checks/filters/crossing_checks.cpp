#include <fmt/format.h>

#include "reference/filters/feature_pair.h"
#include "verification/oracles/feature_distance.h"
#include "verification/specimens/check.h"
#include "verification/specimens/random.h"

namespace foldproof {

namespace {

/// Makes four points of one kind, new ones at each call.
struct PointMaker {
  std::string name;
  Corners4 (*make)(Random& random);
};

Corners4 anywhere(Random& random) { return random.vectors(4, 1); }

/// Few positions, so that points, edges and planes coincide, edges are parallel or degenerate, and
/// triangles collapse to lines.
Corners4 on_a_lattice(Random& random) {
  Corners4 x;
  for (double& c : x.reshaped()) c = std::floor(random.uniform(-2, 3));
  return x;
}

Corners4 far_away(Random& random) { return anywhere(random).colwise() + Vector3(1000, -998, 1001); }

const std::vector<PointMaker>& makers() {
  static const std::vector<PointMaker> all = {
      {"anywhere", anywhere}, {"on a lattice", on_a_lattice}, {"far from the origin", far_away}};
  return all;
}

constexpr PairKind kinds[] = {PairKind::vertex_triangle, PairKind::edge_edge};

std::string name_of(PairKind kind) {
  return kind == PairKind::vertex_triangle ? "vertex and triangle" : "two edges";
}

oracles::Estimate true_distance(PairKind kind, const Corners4& x) {
  return oracles::feature_distance(kind == PairKind::vertex_triangle
                                       ? oracles::Features::vertex_and_triangle
                                       : oracles::Features::edge_and_edge,
                                   x);
}

/// Two edges whose directions differ by the sine s, one above the other or crossing it, inside
/// both; or a triangle with such a small angle, and a vertex above it or in it.
Corners4 thin(Random& random, PairKind kind, double s) {
  Corners4 x = anywhere(random);
  const Vector3 d = x.col(1) - x.col(0), across = random.vectors(1, 1).col(0);
  const Vector3 n = d.cross(across).normalized();
  const double height = random.uniform(0, 1) < 0.5 ? 0 : random.log_uniform(1e-12, 1);
  if (kind == PairKind::edge_edge) {
    const Vector3 e = d + s * d.norm() * across;
    x.col(2) = x.col(0) + random.uniform(0.2, 0.8) * d - random.uniform(0.2, 0.8) * e + height * n;
    x.col(3) = x.col(2) + e;
    return x;
  }
  x.col(2) = x.col(0) + d;
  x.col(3) = x.col(0) + random.uniform(-1, 2) * d + s * d.norm() * across;
  x.col(1) = x.col(0);
  const double a = random.uniform(0, 1), b = random.uniform(0, 1 - a);
  x.col(0) = (1 - a - b) * x.col(1) + a * x.col(2) + b * x.col(3) + height * n;
  return x;
}

/// The worst error of the distance between features, over `count` samples, in units of `scale`.
oracles::Estimate worst_distance(PairKind kind, int count, const std::function<Corners4()>& make,
                                 const std::function<double(const Corners4&)>& scale) {
  Worst worst, uncertainty;
  for (int k = 0; k < count; ++k) {
    const Corners4 x = make();
    const double unit = scale(x);
    if (unit == 0) continue;  // all four at the origin
    const oracles::Estimate truth = true_distance(kind, x);
    worst.observe(std::abs(nearness(kind, x).distance - truth.value) / unit);
    uncertainty.observe(truth.uncertainty / unit);
  }
  return {worst.value(), uncertainty.value()};
}

Finding distance_is_exact() {
  Table measured = roundings_of("max |x|");
  const auto rounding = [](const Corners4& x) { return epsilon * x.cwiseAbs().maxCoeff(); };
  for (const PairKind kind : kinds)
    for (const PointMaker& maker : makers()) {
      Random random(23);
      measured.row(name_of(kind) + ", " + maker.name,
                   worst_distance(
                       kind, 3000, [&] { return maker.make(random); }, rounding));
    }
  return judge_worst(measured, 16,
                     "each coordinate of the vector between the nearest points is a sum of four "
                     "products, and errors of the weights move these points along their features, "
                     "which changes their distance in second order");
}

Finding thin_ones_are_as_good() {
  Table measured{{"case", ""}, {"largest error over the extent", "1"}};
  for (const PairKind kind : kinds)
    for (double s = 0.1; s > 1e-13; s /= 10) {
      Random random(29);
      const auto make = [&] { return thin(random, kind, s * random.uniform(0.3, 3)); };
      measured.row(name_of(kind) + fmt::format(", sine {:.0e}", s),
                   worst_distance(kind, 300, make, [](const Corners4& x) {
                     return (x.rowwise().maxCoeff() - x.rowwise().minCoeff()).norm();
                   }));
    }
  return judge_worst(measured, 1e-9,
                     "thinner or more parallel features are tested at their sides and ends only, "
                     "which can miss as much of their extent");
}

/// Difference between the weights and those of two points, one of each feature [1].
double weight_error(PairKind kind, const Eigen::Vector4d& w) {
  const int first = kind == PairKind::vertex_triangle ? 1 : 2;
  Worst worst;
  worst.observe(std::abs(w.head(first).sum() - 1));
  worst.observe(std::abs(w.tail(4 - first).sum() + 1));
  for (int k = 0; k < 4; ++k) worst.observe(k < first ? -w[k] : w[k]);
  return worst.value();
}

Finding weights_lead_across() {
  Table measured = roundings_of("1, and of max |x|");
  for (const PairKind kind : kinds)
    for (const PointMaker& maker : makers()) {
      Random random(31);
      Worst worst;
      for (int k = 0; k < 3000; ++k) {
        const Corners4 x = maker.make(random);
        const Nearness at = nearness(kind, x);
        const double scale = std::max(x.cwiseAbs().maxCoeff(), 1.0);
        worst.observe(weight_error(kind, at.weights) / epsilon);
        worst.observe((x * at.weights - at.distance * at.normal).norm() / (epsilon * scale));
        worst.observe(std::abs(at.normal.norm() - (at.distance > 0 ? 1 : 0)) / epsilon);
      }
      measured.row(name_of(kind) + ", " + maker.name, worst.value());
    }
  return judge_worst(measured, 8, "sums of four products, a root and a division");
}

}  // namespace

std::vector<Check> crossing_checks() {
  const char* source = "Bridson, Fedkiw and Anderson (2002), section 6";
  return {
      {"nearness.distance-is-exact",
       "The distance of a vertex to a triangle, and of two edges, is the least of all points, "
       "degenerate or not.",
       source, distance_is_exact},
      {"nearness.distance-is-exact-for-thin-features",
       "The distance is as exact for arbitrarily thin triangles and arbitrarily parallel edges.",
       source, thin_ones_are_as_good},
      {"nearness.weights-locate-the-nearest-points",
       "The weights give a point on each feature; these two points are the distance apart, along "
       "the normal.",
       source, weights_lead_across}};
}

}  // namespace foldproof
