// Systems: their masses, and prescribed motions.
#include <catch2/catch.hpp>

#include "reference/dynamics/integrator.h"

using namespace foldproof;
using Catch::Matchers::Contains;

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

PerParticle three_masses() { return (PerParticle(3) << 0.4, 0.7, 0.9).finished(); }

}  // namespace

TEST_CASE("a system's masses are positive and finite, or the first other one is named") {
  for (const double wrong : {0.0, -0.3, infinite, double(NAN)})
    for (int i = 0; i < 3; ++i) {
      PerParticle mass = three_masses();
      mass.tail(3 - i).setConstant(wrong);
      CHECK_THROWS_WITH(make_system(mass), Contains("particle " + std::to_string(i)));
    }
}

TEST_CASE("a particle's motion is prescribed once, and only if there is the particle") {
  System system = make_system(three_masses());
  prescribe(system, {2, {1, 2, 3}, {}});
  prescribe(system, {0, {4, 5, 6}, {}});
  CHECK(system.inverse_mass == Vector3(0, 1 / 0.7, 0));
  CHECK(system.mass == three_masses());
  for (const auto& [particle, why] : {std::pair{-1, "-1"}, {3, "particle 3"}, {2, "twice"}})
    CHECK_THROWS_WITH(prescribe(system, {particle, {1, 2, 3}, {}}), Contains(why));
  REQUIRE(system.prescribed.size() == 2);
  CHECK(system.prescribed[1].start == Vector3(4, 5, 6));
}
