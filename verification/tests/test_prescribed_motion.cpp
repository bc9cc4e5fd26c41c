// Prescribed motion of points and bodies, where it does least.
#include <catch2/catch.hpp>

#include "reference/motion/pose.h"

using namespace foldproof;

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
