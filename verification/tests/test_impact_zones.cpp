// Zones of colliding cloth: which particles are in one, and how many there are.
#include <catch2/catch.hpp>

#include "reference/filters/impact_zones.h"

using namespace foldproof;

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
