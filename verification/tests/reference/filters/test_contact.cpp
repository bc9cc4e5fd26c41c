// Pairs of features of the cloth: how near they are, when they meet, and what repels them.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>

#include "reference/filters/approach.h"
#include "reference/filters/feature_pair.h"
#include "reference/filters/repulsion.h"

using namespace foldproof;

namespace {

Corners4 corners(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) {
  Corners4 x;
  x << a, b, c, d;
  return x;
}

/// The least distance between points of the two features on a lattice, `steps` to a side.
double least_on_lattice(PairKind kind, const Corners4& x, int steps) {
  double least = 1e300;
  for (int i = 0; i <= steps; ++i)
    for (int j = 0; j <= steps; ++j) {
      const double a = double(i) / steps, b = double(j) / steps;
      Eigen::Vector4d w(1 - a, a, b - 1, -b);
      if (kind == PairKind::vertex_triangle) {
        if (i + j > steps) continue;
        w = {1, a + b - 1, -a, -b};
      }
      least = std::min(least, (x * w).norm());
    }
  return least;
}

/// The distance is attained by the weights, along the normal, and no lattice point is nearer.
void check_nearness(PairKind kind, const Corners4& x) {
  const Nearness at = nearness(kind, x);
  CHECK((x * at.weights - at.distance * at.normal).norm() < 1e-14);
  CHECK(at.normal.norm() == Approx(1).epsilon(1e-14));
  const double least = least_on_lattice(kind, x, 200);
  CHECK(at.distance <= least * (1 + 1e-14));
  CHECK(at.distance > least - 0.02);
  const int first = kind == PairKind::vertex_triangle ? 1 : 2;
  CHECK(at.weights.head(first).sum() == Approx(1).epsilon(1e-14));
  CHECK(at.weights.tail(4 - first).sum() == Approx(-1).epsilon(1e-14));
  CHECK(at.weights.head(first).minCoeff() >= 0);
  CHECK(at.weights.tail(4 - first).maxCoeff() <= 0);
}

const Vector3 t1(0.1, 0.2, 0.3), t2(1.3, 0.1, 0.5), t3(0.4, 1.1, 0.2);

}  // namespace

TEST_CASE("nearness: a vertex over the inside, beyond each side and beyond each corner") {
  const Vector3 n = (t2 - t1).cross(t3 - t1).normalized(), middle = (t1 + t2 + t3) / 3;
  std::vector<Vector3> feet{middle, 0.2 * t1 + 0.5 * t2 + 0.3 * t3};
  for (const Vector3& corner : {t1, t2, t3}) {
    feet.push_back(middle + 1.7 * (corner - middle));
    feet.push_back(middle - 0.9 * (corner - middle));  // beyond the side across
  }
  for (const Vector3& foot : feet)
    for (const double height : {0.4, -0.3})
      check_nearness(PairKind::vertex_triangle, corners(foot + height * n, t1, t2, t3));
  const Nearness at = nearness(PairKind::vertex_triangle,
                               corners(0.2 * t1 + 0.5 * t2 + 0.3 * t3 - 0.3 * n, t1, t2, t3));
  CHECK((at.weights - Eigen::Vector4d(1, -0.2, -0.5, -0.3)).norm() < 1e-14);
  CHECK(at.distance == Approx(0.3));
  CHECK((at.normal + n).norm() < 1e-14);
}

TEST_CASE("nearness: edges across each other, past an end of either, and past both") {
  const Vector3 a(0.1, 0, 0), b(1.3, 0.2, -0.1);
  for (const double shift : {-1.5, -0.2, 0.5, 1.2, 2.5})
    for (const double slide : {-1.4, 0.1, 0.6, 1.3}) {
      const Vector3 foot = a + shift * (b - a), along(0.3, 0.9, 0.2);
      const Vector3 c = foot + Vector3(0.02, 0, 0.45) - slide * along;
      check_nearness(PairKind::edge_edge, corners(a, b, c, c + along));
      check_nearness(PairKind::edge_edge, corners(c + along, c, b, a));
    }
}

TEST_CASE("nearness: parallel edges, points for edges, lines and points for triangles") {
  const Vector3 a(0.1, 0.3, 0), d(0.7, 0.2, -0.4), aside(0.1, -0.35, 0);
  for (const double slide : {-2.3, -0.4, 0.0, 0.8, 1.6})
    for (const double length : {1.0, 0.3, -0.7}) {
      const Vector3 c = a + slide * d + aside;
      check_nearness(PairKind::edge_edge, corners(a, a + d, c, c + length * d));
    }
  const Vector3 point(0.3, 0.9, 0.4);
  check_nearness(PairKind::edge_edge, corners(a, a + d, point, point));
  check_nearness(PairKind::edge_edge, corners(point, point, a, a + d));
  check_nearness(PairKind::vertex_triangle, corners(point, a, a + 0.3 * d, a + d));
  check_nearness(PairKind::vertex_triangle, corners(point, a + d, a, a + 0.6 * d));
  check_nearness(PairKind::vertex_triangle, corners(point, a, a, a));
}

TEST_CASE("nearness: features that touch have no direction") {
  const Nearness at = nearness(PairKind::vertex_triangle, corners(t2, t1, t2, t3));
  CHECK(at.distance < 1e-15);
  const Vector3 a(0.5, 0.25, 0);
  const Nearness crossed = nearness(
      PairKind::edge_edge,
      corners(a, a + Vector3(1, 0, 0), a + Vector3(0.5, -0.5, 0), a + Vector3(0.5, 0.5, 0)));
  CHECK(crossed.distance == 0);
  CHECK(crossed.normal == Vector3::Zero());
  CHECK(crossed.weights == Eigen::Vector4d(0.5, 0.5, -0.5, -0.5));
}

TEST_CASE("a pair's columns are those of its particles, in its order") {
  PerParticle3 x(3, 6);
  for (Eigen::Index i = 0; i < 6; ++i) x.col(i) << double(i), 10.0 * double(i), -double(i);
  const Corners4 columns = corners_of({PairKind::edge_edge, {4, 0, 5, 2}}, x);
  CHECK(columns.row(0) == Eigen::RowVector4d(4, 0, 5, 2));
  CHECK(columns.row(1) == Eigen::RowVector4d(40, 0, 50, 20));
}

// ----
// approach ------------------------------------------------------------------------------------

TEST_CASE("approach: a vertex on its way into a triangle is reported before it has used half") {
  const Vector3 n = (t2 - t1).cross(t3 - t1).normalized(), foot = (t1 + t2 + t3) / 3;
  const Corners4 x = corners(foot + 0.4 * n, t1, t2, t3);
  Corners4 down = Corners4::Zero();
  down.col(0) = -n;
  const auto met = first_approach(PairKind::vertex_triangle, x, down, 0.1);
  REQUIRE(met);
  // reported within 1.5 times the distance, and never below it
  CHECK(met->at.distance <= 0.15 + 1e-12);
  CHECK(met->at.distance > 0.1);
  CHECK(met->time == Approx(0.4 - met->at.distance).epsilon(1e-12));
  down *= 0.2;  // ends .2 above it
  CHECK_FALSE(first_approach(PairKind::vertex_triangle, x, down, 0.1));
}

TEST_CASE("approach: features that start nearer may lose half of their distance") {
  const Corners4 x = corners({0, 0, 0}, {1, 0.1, 0}, {0.4, -0.5, 0.08}, {0.5, 0.6, 0.08});
  Corners4 down = Corners4::Zero();
  down.rightCols(2).row(2).setConstant(-0.01);
  CHECK_FALSE(first_approach(PairKind::edge_edge, x, down, 0.1));
  down *= 5;  // from .08 to .03
  const auto met = first_approach(PairKind::edge_edge, x, down, 0.1);
  REQUIRE(met);
  CHECK(met->at.distance > 0.04);
  CHECK(met->at.distance <= 0.06 + 1e-12);
}

TEST_CASE("approach: a common motion is none, and one that parts neither") {
  const Corners4 x = corners({0, 0, 0}, {1, 0.1, 0}, {0.4, -0.5, 0.2}, {0.5, 0.6, 0.2});
  Corners4 motion = Corners4::Zero();
  motion.colwise() = Vector3(3, -400, 7);
  CHECK_FALSE(first_approach(PairKind::edge_edge, x, motion, 0.1));
  motion.rightCols(2).row(2).array() += 5;
  CHECK_FALSE(first_approach(PairKind::edge_edge, x, motion, 0.1));
  motion.rightCols(2).row(2).array() -= 10;  // through each other and far beyond
  CHECK(first_approach(PairKind::edge_edge, x, motion, 0.1));
}

// ----
// repulsion -----------------------------------------------------------------------------------

namespace {

/// A vertex, particle 4, so high over the triangle of particles 0, 2 and 3, at the weights .2, .5
/// and .3; particle 1 is far off.
struct Stack {
  FeaturePair pair{PairKind::vertex_triangle, {4, 0, 2, 3}};
  PerParticle3 x = PerParticle3::Zero(3, 5), v = PerParticle3::Zero(3, 5);
  PerParticle inverse_mass = (PerParticle(5) << 1.5, 4, 2, 0, 3).finished();
  Eigen::Vector4d w{1, -0.2, -0.5, -0.3};
  // sum w^2/m with the vertex' 3, then 1.5, 2 and 0 (prescribed)
  double compliance = 3 + 0.04 * 1.5 + 0.25 * 2;

  explicit Stack(double height) {
    x.col(0) << 0.1, 0.2, 0;
    x.col(1) << 50, 50, 50;
    x.col(2) << 1.3, 0.1, 0;
    x.col(3) << 0.4, 1.1, 0;
    x.col(4) = 0.2 * x.col(0) + 0.5 * x.col(2) + 0.3 * x.col(3) + Vector3(0, 0, height);
  }
  Vector3 relative() const { return corners_of(pair, v) * w; }
};

}  // namespace

TEST_CASE("repulsion: an impulse is shared out by weight and inverse mass") {
  Stack stack(0.02);
  stack.v.setConstant(0.7);
  const PerParticle3 before = stack.v;
  const Vector3 change(0.3, -0.1, 0.9);
  push_apart(stack.pair, stack.w, change, stack.inverse_mass, stack.v);
  CHECK((stack.relative() - change).norm() < 1e-14);
  CHECK((stack.v.col(4) - before.col(4) - 3 / stack.compliance * change).norm() < 1e-14);
  CHECK((stack.v.col(2) - before.col(2) + 0.5 * 2 / stack.compliance * change).norm() < 1e-14);
  CHECK(stack.v.col(3) == before.col(3));
  CHECK(stack.v.col(1) == before.col(1));
  push_apart(stack.pair, stack.w, change, PerParticle::Zero(5), stack.v);
  CHECK(stack.v.col(3) == before.col(3));
  CHECK(stack.v.allFinite());
}

TEST_CASE("repulsion: friction takes at most its share of the push, and never turns a slide") {
  const Vector3 N(0, 0.6, 0.8), slide(0.5, 0.8, -0.6);
  const Vector3 relative = slide - 2 * N;
  const double speed = slide.norm();
  CHECK((friction_impulse(relative, N, 0.3, 0.4) + 0.12 / speed * slide).norm() < 1e-15);
  CHECK((friction_impulse(relative, N, 9, 0.4) + slide).norm() < 1e-15);
  CHECK(friction_impulse(relative, N, 0.3, 0) == Vector3::Zero());
  CHECK(friction_impulse(Vector3::Zero(), N, 0.3, 0.4) == Vector3::Zero());
}

TEST_CASE("repulsion: its rate is that of the formula, in each of its regimes") {
  const double s = 0.05, d = 0.03, h = 0.01, wanted = 0.1 * d / h;
  const auto parting_after = [&](double before, double k) {
    Stack stack(s - d);
    stack.v.col(4) << 0, 0, before;
    CHECK(repel({stack.pair}, stack.x, {s, k, 0}, h, stack.inverse_mass, stack.v, 1) ==
          (before < wanted ? 1 : 0));
    return stack.relative().z();
  };
  const double compliance = Stack(1).compliance, soft = 20;
  const double by_spring = h * soft * d * compliance;
  REQUIRE(by_spring < wanted);
  CHECK(parting_after(-2, soft) == Approx(by_spring).epsilon(1e-12));
  CHECK(parting_after(0.1, soft) == Approx(0.1 + by_spring).epsilon(1e-12));
  CHECK(parting_after(wanted - by_spring / 2, soft) == Approx(wanted).epsilon(1e-12));
  CHECK(parting_after(-2, 1e6) == Approx(wanted).epsilon(1e-12));
  CHECK(parting_after(2 * wanted, soft) == Approx(2 * wanted).epsilon(1e-12));
}

TEST_CASE("repulsion: what slides over what is rubbed by the change of its speed") {
  Stack stack(0.02);
  stack.v.col(4) << 0.5, 0, -2;
  repel({stack.pair}, stack.x, {0.05, 1e6, 0.1}, 0.01, stack.inverse_mass, stack.v, 1);
  // from -2 to .1 * .03/.01 = .3: 2.3 m/s, of which a tenth is friction
  CHECK((stack.relative() - Vector3(0.5 - 0.23, 0, 0.3)).norm() < 1e-12);
}

TEST_CASE("repulsion: pairs as far apart as the thickness, or that touch, are left alone") {
  for (const double height : {0.0625, 0.07, 0.0}) {
    Stack stack(height);
    if (height == 0) stack.x.col(4) = stack.x.col(2);
    CHECK(repel({stack.pair}, stack.x, {0.0625, 1e6, 0.1}, 0.01, stack.inverse_mass, stack.v, 1) ==
          0);
    CHECK(stack.v == PerParticle3::Zero(3, 5));
  }
  Stack held(0.02);
  CHECK(repel({held.pair}, held.x, {0.05, 1e6, 0}, 0.01, PerParticle::Zero(5), held.v, 1) == 0);
}

TEST_CASE("repulsion: edges count where they are nearest inside both") {
  PerParticle3 x(3, 4);
  x << 0, 1, 0.5, 0.5, 0, 0, -0.5, 0.5, 0, 0, 0.02, 0.02;
  const FeaturePair edges{PairKind::edge_edge, {0, 1, 2, 3}};
  const PerParticle inverse_mass = PerParticle::Ones(4);
  PerParticle3 v = PerParticle3::Zero(3, 4);
  CHECK(repel({edges}, x, {0.05, 1e6, 0}, 0.01, inverse_mass, v, 1) == 1);
  CHECK(v(2, 2) > 0);
  x.rightCols(2).row(1).array() += 0.5;  // its end lies over the first edge
  v.setZero();
  CHECK(repel({edges}, x, {0.05, 1e6, 0}, 0.01, inverse_mass, v, 1) == 0);
  CHECK(v == PerParticle3::Zero(3, 4));
}

TEST_CASE("repulsion: over a rim a vertex counts against its nearest triangle alone") {
  // two triangles with the side from 1 to 2 in common, and a vertex beyond the rim of the second
  PerParticle3 x(3, 5);
  x << 0.5, 0, 1, 0.5, 0.5, -1, 0, 0, 1, 0.4, 0, 0, 0, 0, 0.02;
  const FeaturePair over_rim{PairKind::vertex_triangle, {4, 0, 1, 2}},
      over_inside{PairKind::vertex_triangle, {4, 1, 2, 3}};
  const PerParticle inverse_mass = PerParticle::Ones(5);
  const SelfCollisionSettings thick{0.5, 1e6, 0}, thin{0.05, 1e6, 0};
  PerParticle3 v = PerParticle3::Zero(3, 5);
  CHECK(repel({over_rim, over_inside}, x, thick, 0.01, inverse_mass, v, 1) == 1);
  CHECK(v(2, 0) == 0);  // the corner of the first alone
  CHECK(v(2, 3) < 0);
  v.setZero();
  CHECK(repel({over_rim}, x, thick, 0.01, inverse_mass, v, 2) == 1);  // nothing is nearer
  CHECK(repel({over_rim}, x, thin, 0.01, inverse_mass, v, 1) == 0);   // .4 away
}
