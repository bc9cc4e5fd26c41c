// Nearest points of two features and the time at which they approach, against conditions that
// characterize them.
#include <algorithm>
#include <catch2/catch.hpp>
#include <random>

#include "reference/filters/approach.h"
#include "reference/filters/feature_pair.h"

using namespace foldproof;

namespace {

Corners4 columns(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) {
  Corners4 x;
  x << a, b, c, d;
  return x;
}

/// Of two convex features the points p and q are nearest exactly if no corner of either lies beyond
/// its point towards the other: (p - q).(x_i - p) >= 0, (q - p).(x_j - q) >= 0.
void check_nearest(PairKind kind, const Corners4& x, double tolerance = 1e-13) {
  const Nearness at = nearness(kind, x);
  const int first = kind == PairKind::vertex_triangle ? 1 : 2;
  const Eigen::Vector4d w = at.weights;
  CHECK(w.head(first).minCoeff() >= 0);
  CHECK(w.tail(4 - first).maxCoeff() <= 0);
  CHECK(w.head(first).sum() == Approx(1).epsilon(1e-14));
  CHECK(w.tail(4 - first).sum() == Approx(-1).epsilon(1e-14));
  const Vector3 p = x.leftCols(first) * w.head(first),
                q = -x.rightCols(4 - first) * w.tail(4 - first);
  CHECK((p - q - at.distance * at.normal).norm() < tolerance);
  CHECK(at.normal.norm() == Approx(at.distance > 0 ? 1 : 0));
  const double size = x.colwise().norm().maxCoeff();
  for (int i = 0; i < first; ++i) CHECK((p - q).dot(x.col(i) - p) >= -tolerance * size * size);
  for (int j = first; j < 4; ++j) CHECK((q - p).dot(x.col(j) - q) >= -tolerance * size * size);
}

void check_both(const Corners4& x, double tolerance = 1e-13) {
  check_nearest(PairKind::vertex_triangle, x, tolerance);
  check_nearest(PairKind::edge_edge, x, tolerance);
}

Corners4 random_corners(std::mt19937& random, double size) {
  std::uniform_real_distribution<double> coordinate(-size, size);
  return Corners4::NullaryExpr([&] { return coordinate(random); });
}

}  // namespace

TEST_CASE("the corners of a pair are the columns of its particles") {
  PerParticle3 of(3, 5);
  of << 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15;
  Corners4 expected;
  expected << 4, 1, 5, 3, 9, 6, 10, 8, 14, 11, 15, 13;
  CHECK(corners_of({PairKind::edge_edge, {3, 0, 4, 2}}, of) == expected);
}

TEST_CASE("an edge without length is touched at its first end") {
  const Vector3 from(0.3, 1.2, -0.7), along(1.1, -0.4, 0.9), point = from - 0.5 * along;
  const Nearness at = nearness(PairKind::edge_edge, columns(from, from + along, point, point));
  CHECK(at.weights == Eigen::Vector4d(1, 0, -1, 0));
  CHECK(at.distance == Approx(0.5 * along.norm()));
}

TEST_CASE("nearest points of random features are where no corner lies beyond them") {
  std::mt19937 random(71);
  for (int k = 0; k < 300; ++k) check_both(random_corners(random, 1.3));
}

TEST_CASE("the vertex is nearest to the inside, each side and each corner of the triangle") {
  const Vector3 a(0, 0, 0.5), b(4, 0, 0.5), c(0, 4, 0.5);
  const auto weights_of = [&](const Vector3& vertex) {
    const Corners4 x = columns(vertex, a, b, c);
    check_nearest(PairKind::vertex_triangle, x);
    return Eigen::Vector4d(nearness(PairKind::vertex_triangle, x).weights);
  };
  CHECK(weights_of({1, 2, 3}) == Eigen::Vector4d(1, -0.25, -0.25, -0.5));
  CHECK(weights_of({1, -2, 3}) == Eigen::Vector4d(1, -0.75, -0.25, 0));
  CHECK(weights_of({-2, 3, 3}) == Eigen::Vector4d(1, -0.25, 0, -0.75));
  CHECK(weights_of({4, 6, 3}) == Eigen::Vector4d(1, 0, -0.25, -0.75));
  CHECK(weights_of({-1, -2, 3}) == Eigen::Vector4d(1, -1, 0, 0));
  CHECK(weights_of({7, -1, 3}) == Eigen::Vector4d(1, 0, -1, 0));
  CHECK(weights_of({-1, 9, 3}) == Eigen::Vector4d(1, 0, 0, -1));
  CHECK(weights_of({1, 0, 3}) == Eigen::Vector4d(1, -0.75, -0.25, 0));  // above a side
  CHECK(nearness(PairKind::vertex_triangle, columns({1, 2, 3}, a, b, c)).normal ==
        Vector3(0, 0, 1));
  CHECK(nearness(PairKind::vertex_triangle, columns({1, 2, -3}, a, b, c)).distance == 3.5);
}

TEST_CASE("two edges are nearest inside both, at an end of one, or at an end of both") {
  const Vector3 a(0, 0, 0), b(4, 0, 0);
  const auto weights_of = [&](const Vector3& c, const Vector3& d) {
    const Corners4 x = columns(a, b, c, d);
    check_nearest(PairKind::edge_edge, x);
    check_nearest(PairKind::edge_edge, columns(c, d, a, b));
    return Eigen::Vector4d(nearness(PairKind::edge_edge, x).weights);
  };
  CHECK(weights_of({1, -1, 2}, {1, 3, 2}) == Eigen::Vector4d(0.75, 0.25, -0.75, -0.25));
  CHECK(weights_of({1, 1, 2}, {1, 3, 2}) == Eigen::Vector4d(0.75, 0.25, -1, 0));
  CHECK(weights_of({1, -3, 2}, {1, -1, 2}) == Eigen::Vector4d(0.75, 0.25, 0, -1));
  CHECK(weights_of({-1, -1, 2}, {-1, 3, 2}) == Eigen::Vector4d(1, 0, -0.75, -0.25));
  CHECK(weights_of({5, -1, 2}, {5, 3, 2}) == Eigen::Vector4d(0, 1, -0.75, -0.25));
  CHECK(weights_of({5, 1, 2}, {6, 3, 2}) == Eigen::Vector4d(0, 1, -1, 0));
  CHECK(weights_of({-2, 3, 2}, {-1, 1, 2}) == Eigen::Vector4d(1, 0, 0, -1));
  // the ends of the other are right above, exactly
  CHECK(weights_of({1, 0, 2}, {1, 3, 2}) == Eigen::Vector4d(0.75, 0.25, -1, 0));
  CHECK(weights_of({0, -1, 2}, {0, 3, 2}) == Eigen::Vector4d(1, 0, -0.75, -0.25));
  CHECK(weights_of({4, -1, 2}, {4, 3, 2}) == Eigen::Vector4d(0, 1, -0.75, -0.25));
}

TEST_CASE("degenerate features are treated as what they are: edges and points") {
  const Vector3 a(0.3, -0.2, 0.7), b(1.4, 0.5, -0.3), p(0.6, 1.1, 0.9), q(-0.8, 0.4, 1.7);
  const Vector3 between = 0.3 * a + 0.7 * b, beyond = -0.6 * a + 1.6 * b;
  check_both(columns(p, a, b, between));  // triangles in a line
  check_both(columns(p, a, between, b));
  check_both(columns(p, between, a, b));
  check_both(columns(q, a, b, beyond));
  check_both(columns(q, a, a, b));
  check_both(columns(q, b, a, a));
  check_both(columns(q, a, b, a));
  check_both(columns(q, a, a, a));  // a triangle that is a point, an edge that is one
  check_both(columns(a, a, p, q));
  check_both(columns(a, a, b, b));
  check_both(columns(p, q, a, a));
  check_both(columns(a, a, a, a));
  check_nearest(PairKind::edge_edge, columns(a, b, a + p, b + p));  // parallel
  check_nearest(PairKind::edge_edge, columns(a, b, b + p, a + p));
  check_nearest(PairKind::edge_edge, columns(a, b, beyond + p, b + 2 * (b - a) + p));
  check_nearest(PairKind::edge_edge, columns(a, b, beyond, b + 2 * (b - a)));  // in one line
  check_nearest(PairKind::edge_edge, columns(beyond, b + 2 * (b - a), b, a));
}

TEST_CASE("thin triangles and nearly parallel edges keep the accuracy of their nearest points") {
  std::mt19937 random(13);
  for (const double thin : {1e-3, 1e-5, 1e-7, 2e-8, 3e-9, 3e-10, 1e-12})
    for (int k = 0; k < 40; ++k) {
      const Corners4 r = random_corners(random, 1);
      const double along = r(0, 3) + 0.3;
      const Vector3 line = r.col(2) - r.col(1);
      const Vector3 off = line.unitOrthogonal() * thin;
      check_nearest(PairKind::vertex_triangle,
                    columns(r.col(0), r.col(1), r.col(2), r.col(1) + along * line + off), 3e-9);
      check_nearest(PairKind::edge_edge,
                    columns(r.col(1), r.col(2), r.col(0) + along * line,
                            r.col(0) + (along + 0.7) * line + off),
                    3e-9);
    }
}

TEST_CASE("features that touch are at no distance and have no normal") {
  const Nearness vertex = nearness(PairKind::vertex_triangle,
                                   columns({1, 2, 0.5}, {0, 0, 0.5}, {4, 0, 0.5}, {0, 4, 0.5}));
  CHECK(vertex.distance == 0);
  CHECK(vertex.normal == Vector3::Zero());
  CHECK(vertex.weights == Eigen::Vector4d(1, -0.25, -0.25, -0.5));
  const Nearness edges =
      nearness(PairKind::edge_edge, columns({0, 0, 0}, {4, 0, 0}, {1, -1, 0}, {1, 3, 0}));
  CHECK(edges.distance == 0);
  CHECK(edges.normal == Vector3::Zero());
}

TEST_CASE("of points that are equally near, those at the first end or side stay") {
  CHECK(
      nearness(PairKind::edge_edge, columns({0, 0, 0}, {4, 0, 0}, {1, 0, 2}, {3, 0, 2})).weights ==
      Eigen::Vector4d(0.75, 0.25, -1, 0));
  CHECK(
      nearness(PairKind::edge_edge, columns({1, 0, 2}, {3, 0, 2}, {0, 0, 0}, {4, 0, 0})).weights ==
      Eigen::Vector4d(1, 0, -0.75, -0.25));
}

// A vertex over a triangle, or an edge over another, `height` above it and in parallel planes: one
// plane parts them until the height is the middle between the distance kept and the one reported.
namespace {

Corners4 raised(PairKind kind, double height) {
  Corners4 x;
  if (kind == PairKind::vertex_triangle)
    x = columns({0.5, 0.25, height}, {0, 0, 0}, {2, 0, 0}, {0, 2, 0});
  else
    x = columns({-1, 0.5, height}, {2, 0.5, height}, {0.5, -1, 0}, {0.5, 2, 0});
  return x.colwise() + Vector3(0.5, -0.75, 3);
}

/// The first feature sinks by `way` against the second, and both drift.
Corners4 sinking(PairKind kind, double way) {
  Corners4 displacement = Corners4::Zero();
  displacement.leftCols(kind == PairKind::vertex_triangle ? 1 : 2).row(2).setConstant(-way);
  return displacement.colwise() + Vector3(-0.25, 2, 4);
}

}  // namespace

TEST_CASE("an approach is reported halfway between the distance kept and one half more") {
  for (const PairKind kind : {PairKind::vertex_triangle, PairKind::edge_edge}) {
    const auto approach = [&](double height, double way) {
      return first_approach(kind, raised(kind, height), sinking(kind, way), 0.125);
    };
    // far: kept 0.125, reported within 0.1875, the plane's gap 0.15625
    std::optional<Approach> met = approach(0.875, 0.75);
    REQUIRE(met);
    CHECK(met->time == 0.71875 / 0.75);
    CHECK(met->at.distance == Approx(0.15625).epsilon(1e-14));
    CHECK(met->at.normal == Vector3(0, 0, 1));
    CHECK_FALSE(approach(0.875, 0.71875));  // which ends there
    CHECK_FALSE(approach(0.875, 0.5));
    CHECK_FALSE(approach(0.875, 0));
    CHECK_FALSE(approach(0.875, -3));
    // between one and two such distances: kept 0.125, half of the rest may be used up
    met = approach(0.15625, 1);
    REQUIRE(met);
    CHECK(met->time == Approx(0.15625 - 0.1328125).epsilon(1e-14));
    CHECK_FALSE(approach(0.15625, 0.02));
    // at that distance or nearer: half is kept
    met = approach(0.125, 1);
    REQUIRE(met);
    CHECK(met->time == Approx(0.125 - 0.078125).epsilon(1e-14));
    met = approach(0.0625, 1);
    REQUIRE(met);
    CHECK(met->time == Approx(0.0625 - 0.0390625).epsilon(1e-14));
    CHECK_FALSE(approach(0.0625, 0.02));
    // touching features have nothing left to keep
    met = approach(0, 0);
    REQUIRE(met);
    CHECK(met->time == 0);
    CHECK(met->at.distance == 0);
  }
}

TEST_CASE("what is not reported keeps its distance, and what is reported has kept it until then") {
  std::mt19937 random(29);
  int reported = 0, clear = 0;
  for (int k = 0; k < 400; ++k) {
    const Corners4 x = random_corners(random, 1), displacement = random_corners(random, 0.6);
    const PairKind kind = k % 2 == 0 ? PairKind::vertex_triangle : PairKind::edge_edge;
    const double start = nearness(kind, x).distance, wanted = 0.08;
    const double kept = start > wanted ? wanted : start / 2;
    const std::optional<Approach> met = first_approach(kind, x, displacement, wanted);
    ++(met ? reported : clear);
    const double until = met ? met->time : 1;
    double least = start;
    for (int i = 0; i <= 100; ++i)
      least = std::min(least, nearness(kind, x + until * i / 100 * displacement).distance);
    CHECK(least >= kept);
    if (!met) continue;
    const Nearness then = nearness(kind, x + met->time * displacement);
    CHECK(then.distance == Approx(met->at.distance).epsilon(1e-12));
    CHECK((then.weights - met->at.weights).norm() < 1e-9);
    CHECK(then.distance <= 1.5 * kept);
    CHECK((met->time >= 0 && met->time < 1));
  }
  CHECK(reported > 30);
  CHECK(clear > 150);
}
