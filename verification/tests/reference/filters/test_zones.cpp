// Rigid impact zones: which motion a zone is given.
#include <catch2/catch.hpp>
#include <Eigen/Geometry>

#include "reference/filters/impact_zones.h"

using namespace foldproof;

namespace {

const std::vector<int> zone{0, 1, 3, 4, 5};  // particle 2 is not in it
PerParticle3 places() {
  PerParticle3 x(3, 6);
  x << 0.3, 1.2, 5.0, -0.4, 0.9, 0.2, 0.7, -0.6, 6.0, 0.5, 1.4, -0.9, 2.1, 1.8, 7.0, 2.6, 1.3, 2.9;
  return x;
}
PerParticle3 velocities() {
  PerParticle3 v(3, 6);
  v << 0.4, -0.7, 3.0, 1.1, 0.2, -0.3, 0.9, 0.3, 2.0, -0.8, 0.6, 1.2, -0.5, 0.1, 1.0, 0.7, -1.3,
      0.8;
  return v;
}
PerParticle masses() {
  PerParticle m(6);
  m << 0.7, 1.9, 3.1, 0.4, 2.3, 1.1;
  return m;
}
PerParticle inverse(const PerParticle& mass, const std::vector<int>& prescribed) {
  PerParticle w = mass.cwiseInverse();
  for (const int i : prescribed) w[i] = 0;
  return w;
}

/// The largest rate at which two particles of the zone part, times their distance.
double rate_of_deformation(const PerParticle3& x, const PerParticle3& v) {
  double worst = 0;
  for (const int i : zone)
    for (const int j : zone)
      worst = std::max(worst, std::abs((x.col(i) - x.col(j)).dot(v.col(i) - v.col(j))));
  return worst;
}

/// The angular momentum about p.
Vector3 turning(const PerParticle& m, const PerParticle3& x, const PerParticle3& v,
                const Vector3& p) {
  Vector3 sum = Vector3::Zero();
  for (const int i : zone) sum += m[i] * Vector3(x.col(i) - p).cross(Vector3(v.col(i)));
  return sum;
}
Vector3 momentum(const PerParticle& m, const PerParticle3& v) {
  Vector3 sum = Vector3::Zero();
  for (const int i : zone) sum += m[i] * v.col(i);
  return sum;
}

PerParticle3 rigid(const PerParticle3& x, const Vector3& u, const Vector3& omega) {
  PerParticle3 v(3, x.cols());
  for (Eigen::Index i = 0; i < x.cols(); ++i) v.col(i) = u + omega.cross(Vector3(x.col(i)));
  return v;
}

}  // namespace

TEST_CASE("a free zone moves rigidly with the momentum and angular momentum that it had") {
  const PerParticle m = masses();
  const PerParticle3 x = places(), before = velocities();
  PerParticle3 v = before;
  CHECK(move_as_one(zone, x, m, inverse(m, {}), v) == 0);
  CHECK(rate_of_deformation(x, v) < 1e-13);
  CHECK((momentum(m, v) - momentum(m, before)).norm() < 1e-13);
  CHECK((turning(m, x, v, {0, 0, 0}) - turning(m, x, before, {0, 0, 0})).norm() < 1e-12);
  CHECK(v.col(2) == before.col(2));
  CHECK((v - before).norm() > 0.5);
}

TEST_CASE("prescribed particles that move rigidly take their zone along") {
  const PerParticle m = masses();
  const PerParticle3 x = places(),
                     wanted = rigid(x, Vector3(0.3, -0.8, 0.5), Vector3(1.1, 0.6, -0.9));
  PerParticle3 v = velocities();
  for (const int i : {1, 3, 5}) v.col(i) = wanted.col(i);
  const PerParticle3 before = v;
  CHECK(move_as_one(zone, x, m, inverse(m, {1, 3, 5}), v) < 1e-13);
  for (const int i : zone) CHECK((v.col(i) - wanted.col(i)).norm() < 1e-12);
  for (const int i : {1, 2, 3, 5}) CHECK(v.col(i) == before.col(i));
}

TEST_CASE("one prescribed particle leaves a zone its angular momentum about it") {
  const PerParticle m = masses();
  const PerParticle3 x = places(), before = velocities();
  PerParticle3 v = before;
  CHECK(move_as_one(zone, x, m, inverse(m, {4}), v) < 1e-13);
  CHECK(v.col(4) == before.col(4));
  CHECK(rate_of_deformation(x, v) < 1e-12);
  CHECK((turning(m, x, v, x.col(4)) - turning(m, x, before, x.col(4))).norm() < 1e-12);
}

TEST_CASE("two prescribed particles leave a zone its angular momentum about their line") {
  const PerParticle m = masses();
  const PerParticle3 x = places();
  PerParticle3 v = velocities();
  const PerParticle3 carrier = rigid(x, Vector3(0.3, -0.8, 0.5), Vector3(1.1, 0.6, -0.9));
  for (const int i : {0, 5}) v.col(i) = carrier.col(i);
  const PerParticle3 before = v;
  CHECK(move_as_one(zone, x, m, inverse(m, {0, 5}), v) < 1e-12);
  CHECK(rate_of_deformation(x, v) < 1e-12);
  const Vector3 line = x.col(5) - x.col(0);
  CHECK(std::abs((turning(m, x, v, x.col(0)) - turning(m, x, before, x.col(0))).dot(line)) < 1e-12);
}

TEST_CASE("the deviation is that of the prescribed particle which fits a rigid motion least") {
  // two prescribed particles 2 apart part at a relative 0.6: each misses by 0.3
  PerParticle3 x = places(), v = velocities();
  x.col(0) << 0, 0, 0;
  x.col(1) << 2, 0, 0;
  v.col(0) << 0.2, 0.5, -0.1;
  v.col(1) << 0.8, 0.7, 0.4;
  const PerParticle m = masses();
  const PerParticle3 before = v;
  CHECK(move_as_one(zone, x, m, inverse(m, {0, 1}), v) == Approx(0.3).epsilon(1e-12));
  CHECK(v.col(0) == before.col(0));
  CHECK(v.col(1) == before.col(1));
  // of three in a row whose middle is off by 0.6 across, that one: the fit shifts by 0.2
  x.col(3) << 1, 0, 0;
  for (const int i : {0, 1, 3}) v.col(i).setZero();
  v(2, 3) = 0.6;
  CHECK(move_as_one({0, 1, 3}, x, m, inverse(m, {0, 1, 3}), v) == Approx(0.4).epsilon(1e-12));
}

TEST_CASE("a zone in a line and a zone in a point move as one, however small they are") {
  const PerParticle m = masses();
  for (const double size : {1.0, 1e-3, 1e-6}) {
    PerParticle3 x(3, 6), before = velocities();
    for (const int i : zone)
      x.col(i) = Vector3(0.7, -0.4, 0.9) + (0.3 * i - 0.45) * size * Vector3(0.6, 0.3, -0.9);
    x.col(2).setConstant(9);
    PerParticle3 v = before;
    CHECK(move_as_one(zone, x, m, inverse(m, {}), v) == 0);
    CHECK(v.allFinite());
    CHECK(rate_of_deformation(x, v) < 1e-12 * size);
    CHECK((momentum(m, v) - momentum(m, before)).norm() < 1e-12);
    const Vector3 centre(0.7, -0.4, 0.9);
    CHECK((turning(m, x, v, centre) - turning(m, x, before, centre)).norm() < 1e-11 * size + 1e-14);
  }
  PerParticle3 x = PerParticle3::Constant(3, 6, 0.7), before = velocities(), v = before;
  move_as_one(zone, x, m, inverse(m, {}), v);
  double sum = 0;
  for (const int i : zone) sum += m[i];
  for (const int i : zone) CHECK((v.col(i) - momentum(m, before) / sum).norm() < 1e-14);
}

TEST_CASE("zones keep their particles, whichever zone is larger when they join") {
  ImpactZones zones(21);
  zones.join({PairKind::edge_edge, {0, 1, 2, 3}});
  zones.join({PairKind::edge_edge, {10, 11, 12, 13}});
  zones.join({PairKind::edge_edge, {12, 14, 15, 16}});  // seven
  CHECK(zones.particles() == 11);
  CHECK(zones.take_grown_zones().size() == 2);
  CHECK(zones.take_grown_zones().empty());
  zones.join({PairKind::vertex_triangle, {20, 1, 16, 19}});  // all into one
  CHECK(zones.zones() == 1);
  CHECK(zones.particles() == 13);
  CHECK(zones.take_grown_zones() ==
        std::vector<std::vector<int>>{{0, 1, 2, 3, 10, 11, 12, 13, 14, 15, 16, 19, 20}});
  CHECK(zones.are_joined({PairKind::vertex_triangle, {20, 3, 10, 19}}));
  CHECK_FALSE(zones.are_joined({PairKind::vertex_triangle, {20, 3, 10, 18}}));
  CHECK_FALSE(zones.are_joined({PairKind::vertex_triangle, {18, 3, 10, 20}}));
  zones.join({PairKind::vertex_triangle, {0, 20, 19, 12}});  // grown again, though nothing is new
  CHECK(zones.take_grown_zones().size() == 1);
  zones.join({PairKind::edge_edge, {4, 5, 6, 7}});  // the other zone has not grown
  CHECK(zones.take_grown_zones() == std::vector<std::vector<int>>{{4, 5, 6, 7}});
}

TEST_CASE("zones join, grow and are counted without the particles that are in none") {
  ImpactZones zones(13);
  CHECK(zones.zones() == 0);
  CHECK(zones.particles() == 0);
  const FeaturePair first{PairKind::edge_edge, {0, 1, 2, 3}},
      other{PairKind::edge_edge, {8, 7, 6, 9}};
  zones.join(first);
  CHECK(zones.zones() == 1);
  CHECK(zones.particles() == 4);
  zones.join(other);
  CHECK(zones.zones() == 2);
  CHECK(zones.particles() == 8);
  CHECK(zones.are_joined(first));
  CHECK_FALSE(zones.are_joined({PairKind::edge_edge, {0, 1, 6, 7}}));
  CHECK(zones.take_grown_zones() == std::vector<std::vector<int>>{{0, 1, 2, 3}, {6, 7, 8, 9}});
  CHECK(zones.take_grown_zones().empty());
  zones.join({PairKind::vertex_triangle, {3, 9, 11, 12}});
  CHECK(zones.zones() == 1);
  CHECK(zones.particles() == 10);
  CHECK(zones.take_grown_zones() ==
        std::vector<std::vector<int>>{{0, 1, 2, 3, 6, 7, 8, 9, 11, 12}});
}
