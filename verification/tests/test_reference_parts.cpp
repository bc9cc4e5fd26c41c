// Parts of the reference: zones of colliding cloth, and prescribed motion where it does least.
#include <barrier>
#include <catch2/catch.hpp>

#include "reference/fast/threads.h"
#include "reference/filters/impact_zones.h"
#include "reference/motion/pose.h"

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

TEST_CASE("a body that does not turn stays in its place, wherever its centre is") {
  Motion motion;
  motion.center = {0.3, -0.7, 1.9};
  const Vector3 start(2.1, 0.4, -0.8);
  CHECK((position_at(motion, start, 3.7) - start).norm() < 1e-15);
  CHECK(velocity_at(motion, start, 3.7) == Vector3::Zero());
  const Pose pose = pose_at(motion, 3.7);
  CHECK(pose.translation.norm() < 1e-15);
  CHECK((to_world(pose, start) - start).norm() < 1e-15);
  motion.velocity = {0, 0.5, 0};
  CHECK((position_at(motion, start, 2) - start - Vector3(0, 1, 0)).norm() < 1e-15);
}

TEST_CASE("the events of prescribed particles ascend, each once, without those that are over") {
  Motion late, early;
  late.from = 0.7, late.until = 1.9;
  early.from = 0.3, early.until = 0.7;
  const std::vector<PrescribedParticle> particles{{4, Vector3::Zero(), late},
                                                  {7, Vector3::Zero(), early}};
  CHECK(event_times(particles, 0.3) == std::vector<double>{0.7, 1.9});
  CHECK(event_times(particles, 0.1) == std::vector<double>{0.3, 0.7, 1.9});
}

TEST_CASE("threads: all parts of a loop are under way at once") {
  for (const int parts : {2, 3}) {
    std::barrier all_have_begun(parts);  // for which fewer threads would wait for ever
    in_parallel(parts, [&](int) { all_have_begun.arrive_and_wait(); });
    SUCCEED();
  }
}
