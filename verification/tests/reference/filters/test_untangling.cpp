// Untangling: names of crossing triangles, tangled particles, and the push out of a crossing.
#include <catch2/catch.hpp>
#include <Eigen/Geometry>

#include "reference/filters/untangling.h"

using namespace foldproof;

namespace {

// An edge 0-1 of triangle (0, 1, 2) comes down through triangle (3, 4, 5), near its side 3-5.
const std::vector<Triangle> triangles{{0, 1, 2}, {3, 4, 5}};
PerParticle3 crossing_triangles() {
  PerParticle3 x(3, 6);
  x.col(0) << 0.3, 0.7, 0.9;
  x.col(1) << 0.4, 0.6, -0.5;
  x.col(2) << -3.1, 0.8, 0.35;
  x.col(3) << 0, 0, 0.1;
  x.col(4) << 3.2, 0.3, 0.2;
  x.col(5) << 0.1, 2.9, 0.15;
  return x;
}

/// The length of the line in which the first triangle crosses the second, by clipping: from where
/// the edge 0-1 pierces it to the side 3-5.
double line_length(const PerParticle3& x) {
  const auto pierce = [&](int a, int b, int p, int q, int r) {
    const Vector3 n = Vector3(x.col(q) - x.col(p)).cross(Vector3(x.col(r) - x.col(p)));
    const double t = (x.col(p) - x.col(a)).dot(n) / (x.col(b) - x.col(a)).dot(n);
    return Vector3(x.col(a) + t * (x.col(b) - x.col(a)));
  };
  return (pierce(0, 1, 3, 4, 5) - pierce(3, 5, 0, 1, 2)).norm();
}

}  // namespace

TEST_CASE("crossing triangles are listed by number, the first five of them") {
  CHECK(list_triangles({}) == "0 pairs of triangles:");
  CHECK(list_triangles({{12, 40}, {12, 41}}) == "2 pairs of triangles: 12 and 40, 12 and 41");
  CrossingTriangles crossing{{1, 7}, {2, 8}, {3, 9}, {4, 11}, {5, 12}};
  const std::string five = " pairs of triangles: 1 and 7, 2 and 8, 3 and 9, 4 and 11, 5 and 12";
  CHECK(list_triangles(crossing) == "5" + five);
  crossing.emplace_back(6, 13);
  CHECK(list_triangles(crossing) == "6" + five + ", ...");
}

TEST_CASE("particles are tangled in triangles that cross, and pairs whose particles all are go") {
  const std::vector<Triangle> mesh{{0, 1, 2}, {3, 4, 5}, {6, 7, 8}, {2, 9, 10}};
  const std::vector<char> tangled = tangled_particles({{0, 2}}, mesh, 12);
  CHECK(tangled == std::vector<char>{1, 1, 1, 0, 0, 0, 1, 1, 1, 0, 0, 0});
  CHECK(tangled_particles({{1, 3}}, mesh, 12) ==
        std::vector<char>{0, 0, 1, 1, 1, 1, 0, 0, 0, 1, 1, 0});
  std::vector<FeaturePair> pairs{{PairKind::edge_edge, {0, 1, 6, 7}},
                                 {PairKind::vertex_triangle, {3, 6, 7, 8}},
                                 {PairKind::vertex_triangle, {1, 6, 7, 8}},
                                 {PairKind::edge_edge, {0, 1, 6, 11}}};
  remove_tangled_pairs(tangled, pairs);
  REQUIRE(pairs.size() == 2);
  CHECK(pairs[0].particles == std::array<int, 4>{3, 6, 7, 8});
  CHECK(pairs[1].particles == std::array<int, 4>{0, 1, 6, 11});
}

TEST_CASE("the push out of a crossing shortens its line as fast as a push of this kind can") {
  const PerParticle3 x = crossing_triangles();
  PerParticle inverse_mass(6);
  inverse_mass << 0.7, 0.3, 0.9, 0.2, 0.6, 0.4;
  const double speed = 0.13;
  PerParticle3 v = PerParticle3::Zero(3, 6);
  push_out_of_tangle({{0, 1}}, triangles, x, speed, inverse_mass, v);

  // impulses sum to zero and have no torque about the crossing's edge ends: momentum is kept
  Vector3 momentum = Vector3::Zero();
  for (int i = 0; i < 6; ++i) momentum += v.col(i) / inverse_mass[i];
  CHECK(momentum.norm() < 1e-14);

  // Two edges pierce: 0-1 the triangle 3-4-5, and 3-5 the triangle 0-1-2. The pushes are given in
  // turn, so the last is exact: seen from edge 3-5 against triangle 0-1-2 the speed is reached.
  const double eps = 1e-6;
  const double rate = (line_length(x + eps * v) - line_length(x - eps * v)) / (2 * eps);
  CHECK(rate < -speed / 2);

  // turned round, or on the other triangle first, the same line grows shorter as well
  PerParticle3 other = PerParticle3::Zero(3, 6);
  push_out_of_tangle({{0, 1}}, {triangles[1], triangles[0]}, x, speed, inverse_mass, other);
  CHECK((line_length(x + eps * other) - line_length(x - eps * other)) / (2 * eps) < -speed / 2);
}

TEST_CASE(
    "a single piercing edge is pushed along the gradient of the line's length, at the speed") {
  // only the edge 0-1 and the edge 1-2 pierce the large triangle: the line runs between them, all
  // inside it, so that no edge of that triangle pierces
  PerParticle3 x(3, 6);
  x.col(0) << 0.3, 0.7, 0.9;
  x.col(1) << 0.4, 0.6, -0.5;
  x.col(2) << 1.1, 0.9, 0.8;
  x.col(3) << -5, -4, 0.1;
  x.col(4) << 9, -3, 0.2;
  x.col(5) << 0.5, 9, 0.15;
  PerParticle inverse_mass(6);
  inverse_mass << 0.7, 0, 0, 0.2, 0.6, 0.4;  // vertices 1 and 2 are prescribed
  const Vector3 n = Vector3(x.col(4) - x.col(3)).cross(Vector3(x.col(5) - x.col(3)));
  const auto pierce = [&](const PerParticle3& at, int a, int b) {
    const Vector3 N = Vector3(at.col(4) - at.col(3)).cross(Vector3(at.col(5) - at.col(3)));
    const double t = (at.col(3) - at.col(a)).dot(N) / (at.col(b) - at.col(a)).dot(N);
    return std::pair(t, Vector3(at.col(a) + t * (at.col(b) - at.col(a))));
  };
  const auto [t01, p01] = pierce(x, 0, 1);
  const auto [t12, p12] = pierce(x, 1, 2);
  // the direction of each: R - (e.R)/(e.n) n, R along the line towards the other end
  const auto steepest = [&](int a, int b, const Vector3& R) {
    const Vector3 e = x.col(b) - x.col(a);
    return Vector3(R - e.dot(R) / e.dot(n) * n).normalized();
  };
  const Vector3 G01 = steepest(0, 1, (p12 - p01).normalized()),
                G12 = steepest(1, 2, (p01 - p12).normalized());
  const auto weights = [&](double t, const Vector3& p, int a, int b) {
    Eigen::Matrix<double, 6, 1> w = Eigen::Matrix<double, 6, 1>::Zero();
    w[a] = 1 - t, w[b] = t;
    // sums to one: in its plane
    const Vector3 triangle = Eigen::Matrix3d(x.rightCols(3)).colPivHouseholderQr().solve(p);
    w.tail(3) = -triangle;
    return w;
  };
  const auto w01 = weights(t01, p01, 0, 1), w12 = weights(t12, p12, 1, 2);
  PerParticle3 start(3, 6);
  start << 0.2, 0.1, -0.3, 0.05, 0.4, -0.2, 0.3, -0.1, 0.2, 0.1, 0.02, -0.03, 0.1, 0.04, 0.06, -0.2,
      0.15, 0.25;
  for (const double speed : {3.7, 0.0}) {
    PerParticle3 v = start, expected = start;
    push_out_of_tangle({{0, 1}}, triangles, x, speed, inverse_mass, v);
    for (const auto& [w, G] : {std::pair(w01, G01), std::pair(w12, G12)}) {
      const double now = (expected * w).dot(G);
      const double compliance = w.cwiseAbs2().dot(inverse_mass);
      if (now < speed)
        expected += (speed - now) / compliance * G * w.cwiseProduct(inverse_mass).transpose();
    }
    CHECK((v - expected).norm() < 1e-12 * (1 + expected.norm()));
    CHECK(v.col(1) == start.col(1));
    CHECK(v.col(2) == start.col(2));
  }
  PerParticle3 v = start;
  push_out_of_tangle({{0, 1}}, triangles, x, 3.7, PerParticle::Zero(6), v);
  CHECK(v == start);
  push_out_of_tangle({}, triangles, x, 3.7, inverse_mass, v);
  CHECK(v == start);
}

TEST_CASE("triangles that do not pierce each other are not pushed") {
  PerParticle3 x = crossing_triangles();
  const PerParticle inverse_mass = PerParticle::Constant(6, 0.3);
  PerParticle3 v = PerParticle3::Zero(3, 6);
  for (const Vector3& away : {Vector3(0, 0, 2), Vector3(0, 0, -2), Vector3(-0.6, 0, 0),
                              Vector3(6.5, 0, 0), Vector3(0.5, 3, 0), Vector3(0, -2.5, 0)}) {
    PerParticle3 apart = x;
    apart.leftCols(3).colwise() += away;
    push_out_of_tangle({{0, 1}}, triangles, apart, 0.3, inverse_mass, v);
    CHECK(v == PerParticle3::Zero(3, 6));
  }
}
