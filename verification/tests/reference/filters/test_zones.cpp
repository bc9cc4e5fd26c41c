// Rigid impact zones: which motion a zone is given, and how zones join.
#include <catch2/catch.hpp>
#include <Eigen/Geometry>

#include "reference/filters/impact_zones.h"

using namespace foldproof;

namespace {

const std::vector<int> zone{0, 1, 3, 4, 5};  // particle 2 is not in it
const PerParticle3 velocities = (PerParticle3(3, 6) << 0.4, -0.7, 3.0, 1.1, 0.2, -0.3, 0.9, 0.3,
                                 2.0, -0.8, 0.6, 1.2, -0.5, 0.1, 1.0, 0.7, -1.3, 0.8)
                                    .finished();
const PerParticle masses = (PerParticle(6) << 0.7, 1.9, 3.1, 0.4, 2.3, 1.1).finished();

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

TEST_CASE("a zone in a line and a zone in a point move as one, however small they are") {
  const Vector3 centre(0.7, -0.4, 0.9);
  const PerParticle3 before = velocities;
  for (const double size : {1.0, 1e-3, 1e-6}) {
    PerParticle3 x(3, 6), v = before;
    for (const int i : zone) x.col(i) = centre + (0.3 * i - 0.45) * size * Vector3(0.6, 0.3, -0.9);
    x.col(2).setConstant(9);
    CHECK(move_as_one(zone, x, masses, masses.cwiseInverse(), v) == 0);
    CHECK(v.allFinite());
    CHECK(rate_of_deformation(x, v) < 1e-12 * size);
    CHECK((momentum(v) - momentum(before)).norm() < 1e-12);
    CHECK((turning(x, v, centre) - turning(x, before, centre)).norm() < 1e-11 * size + 1e-14);
  }
  PerParticle3 v = before;
  move_as_one(zone, PerParticle3::Constant(3, 6, 0.7), masses, masses.cwiseInverse(), v);
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
