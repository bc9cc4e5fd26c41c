// Rigid impact zones: which motion a zone is given, and how zones join.
#include <catch2/catch.hpp>
#include <Eigen/Geometry>

#include "reference/filters/impact_zones.h"

using namespace foldproof;

namespace {

const std::vector<int> zone{0, 1, 3, 4, 5};  // particle 2 is not in it
const PerParticle3 places = (PerParticle3(3, 6) << 0.3, 1.2, 5.0, -0.4, 0.9, 0.2, 0.7, -0.6, 6.0,
                             0.5, 1.4, -0.9, 2.1, 1.8, 7.0, 2.6, 1.3, 2.9)
                                .finished();
const PerParticle3 velocities = (PerParticle3(3, 6) << 0.4, -0.7, 3.0, 1.1, 0.2, -0.3, 0.9, 0.3,
                                 2.0, -0.8, 0.6, 1.2, -0.5, 0.1, 1.0, 0.7, -1.3, 0.8)
                                    .finished();
const PerParticle masses = (PerParticle(6) << 0.7, 1.9, 3.1, 0.4, 2.3, 1.1).finished();
PerParticle inverse(const std::vector<int>& prescribed) {
  PerParticle w = masses.cwiseInverse();
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
Vector3 turning(const PerParticle3& x, const PerParticle3& v, const Vector3& p) {
  Vector3 sum = Vector3::Zero();
  for (const int i : zone) sum += masses[i] * Vector3(x.col(i) - p).cross(Vector3(v.col(i)));
  return sum;
}
Vector3 momentum(const PerParticle3& v) {
  Vector3 sum = Vector3::Zero();
  for (const int i : zone) sum += masses[i] * v.col(i);
  return sum;
}

}  // namespace

TEST_CASE("a zone follows its prescribed particles, and momentum decides what they leave open") {
  for (const auto& led : std::vector<std::vector<int>>{{}, {4}, {0, 5}, {1, 3, 5}}) {
    PerParticle3 v = velocities;
    for (const int i : led)
      v.col(i) = Vector3(0.3, -0.8, 0.5) + Vector3(1.1, 0.6, -0.9).cross(Vector3(places.col(i)));
    const PerParticle3 before = v;
    CHECK(move_as_one(zone, places, masses, inverse(led), v) < 1e-12);
    CHECK(rate_of_deformation(places, v) < 1e-12);
    CHECK((v - before).norm() > 0.5);
    CHECK(v.col(2) == before.col(2));
    for (const int i : led) CHECK(v.col(i) == before.col(i));
    if (led.size() == 3) continue;
    const Vector3 about = led.empty() ? Vector3(0, 0, 0) : Vector3(places.col(led[0]));
    const Vector3 gained = turning(places, v, about) - turning(places, before, about);
    if (led.empty()) CHECK((momentum(v) - momentum(before)).norm() < 1e-13);
    if (led.size() < 2)
      CHECK(gained.norm() < 1e-12);
    else  // about their line
      CHECK(std::abs(gained.dot(places.col(5) - places.col(0))) < 1e-12);
  }
}

TEST_CASE("the deviation is that of the prescribed particle which fits a rigid motion least") {
  // of three in a row whose middle is off by 0.6 across, that one: the fit shifts by 0.2
  PerParticle3 x = PerParticle3::Zero(3, 6), v = x;
  x.row(0) << 0, 2, 0, 1, 0, 0;
  v(2, 3) = 0.6;
  const PerParticle3 before = v;
  CHECK(move_as_one({0, 1, 3}, x, masses, inverse({0, 1, 3}), v) == Approx(0.4).epsilon(1e-12));
  CHECK(v == before);
}

TEST_CASE("a zone in a line and a zone in a point move as one, however small they are") {
  const Vector3 centre(0.7, -0.4, 0.9);
  const PerParticle3 before = velocities;
  for (const double size : {1.0, 1e-3, 1e-6}) {
    PerParticle3 x(3, 6), v = before;
    for (const int i : zone) x.col(i) = centre + (0.3 * i - 0.45) * size * Vector3(0.6, 0.3, -0.9);
    x.col(2).setConstant(9);
    CHECK(move_as_one(zone, x, masses, inverse({}), v) == 0);
    CHECK(v.allFinite());
    CHECK(rate_of_deformation(x, v) < 1e-12 * size);
    CHECK((momentum(v) - momentum(before)).norm() < 1e-12);
    CHECK((turning(x, v, centre) - turning(x, before, centre)).norm() < 1e-11 * size + 1e-14);
  }
  PerParticle3 v = before;
  move_as_one(zone, PerParticle3::Constant(3, 6, 0.7), masses, inverse({}), v);
  double sum = 0;
  for (const int i : zone) sum += masses[i];
  for (const int i : zone) CHECK((v.col(i) - momentum(before) / sum).norm() < 1e-14);
}

TEST_CASE("zones join, grow and are counted without the particles that are in none") {
  using Zones = std::vector<std::vector<int>>;
  ImpactZones zones(21);
  const auto join = [&](const std::array<int, 4>& particles, long count, long members) {
    zones.join({PairKind::edge_edge, particles});
    CHECK(zones.zones() == count);
    CHECK(zones.particles() == members);
  };
  const auto are_joined = [&](const std::array<int, 4>& particles) {
    return zones.are_joined({PairKind::vertex_triangle, particles});
  };
  CHECK(zones.zones() == 0);
  CHECK(zones.particles() == 0);
  join({0, 1, 2, 3}, 1, 4);
  join({13, 12, 10, 11}, 2, 8);
  join({12, 14, 15, 16}, 2, 11);
  CHECK(are_joined({0, 1, 2, 3}));
  CHECK_FALSE(are_joined({0, 1, 10, 11}));
  CHECK(zones.take_grown_zones() == Zones{{0, 1, 2, 3}, {10, 11, 12, 13, 14, 15, 16}});
  CHECK(zones.take_grown_zones().empty());
  join({20, 1, 16, 19}, 1, 13);  // all into one
  const Zones all{{0, 1, 2, 3, 10, 11, 12, 13, 14, 15, 16, 19, 20}};
  CHECK(zones.take_grown_zones() == all);
  CHECK(are_joined({20, 3, 10, 19}));
  CHECK_FALSE(are_joined({20, 3, 10, 18}));
  CHECK_FALSE(are_joined({18, 3, 10, 20}));
  join({0, 20, 19, 12}, 1, 13);  // grown again, though nothing is new
  CHECK(zones.take_grown_zones() == all);
  join({4, 5, 6, 7}, 2, 17);  // the other zone has not grown
  CHECK(zones.take_grown_zones() == Zones{{4, 5, 6, 7}});
}
