// Bonds of sticking: where they form, when they break, and in what order they are kept.
#include <catch2/catch.hpp>
#include <tuple>

#include "reference/forces/sticking.h"

using namespace foldproof;

namespace {

/// A triangle at rest in the plane z = 0 with two sides of length 1 along the axes.
StickyPatch palm(const std::vector<int>& particles, double near, double far) {
  StickyPatch patch;
  patch.triangles = {{0, 1, 2}};
  patch.place = [](double) { return PerParticle3{{0, 1, 0}, {0, 0, 1}, {0, 0, 0}}; };
  patch.velocity = [](double) { return PerParticle3(PerParticle3::Zero(3, 3)); };
  patch.particles = particles;
  patch.stiffness = 3.1;
  patch.near = near;
  patch.far = far;
  return patch;
}

State state_of(const PerParticle3& x, const std::vector<Bond>& bonds = {}) {
  return {0.5, x, PerParticle3::Zero(3, x.cols()), bonds};
}

using Key = std::tuple<int, int, int>;  // patch, particle, triangle

std::vector<Key> updated(const Sticking& sticking, State& s) {
  sticking.update_bonds(s);
  std::vector<Key> list;
  for (const Bond& bond : s.bonds) list.emplace_back(bond.patch, bond.particle, bond.triangle);
  return list;
}

}  // namespace

TEST_CASE("a particle's bonds to a patch break together, and hold while their mean is near") {
  StickyPatch two = palm({0, 1}, 0.125, 0.5);
  two.triangles.push_back({0, 2, 1});
  // the places lie 0.375 and 0.75 from particle 0, their mean 0.5625; 0.375, 0 and 0.1875 from 1
  const std::vector<Bond> bonds{{0, 0, 0, Vector3(0.25, 0.25, 0)},
                                {0, 1, 0, Vector3(0.25, 0.25, 0.375)},
                                {0, 0, 1, Vector3(0.25, 0.25, 0)},
                                {0, 1, 1, Vector3(0.25, 0.25, -0.375)}};
  State s = state_of(PerParticle3{{0.25, 0.25}, {0.25, 0.25}, {0.375, 0.375}}, bonds);
  CHECK(updated(Sticking{{two}}, s) == std::vector<Key>{{0, 1, 0}, {0, 1, 1}});
}

TEST_CASE("a particle that sticks to a patch forms no more bonds with it, but does with others") {
  StickyPatch two = palm({1, 0}, 0.125, 0.5);
  two.triangles.push_back({0, 2, 1});
  const Vector3 place(0.3, 0.3, 0.03);
  State s = state_of(PerParticle3{{0.25, 0.5}, {0.25, 0.125}, {0.0625, 0.0625}},
                     {{1, 1, 0, place}, {2, 0, 0, place}});
  // kept by patch, particle and triangle, whatever the order in which they form
  const std::vector<Key> all{{0, 0, 0}, {0, 0, 1}, {0, 1, 0}, {0, 1, 1}, {1, 0, 1},
                             {1, 1, 0}, {1, 1, 1}, {2, 0, 0}, {2, 1, 0}};
  CHECK(updated(Sticking{{two, two, palm({0, 1}, 0.125, 0.5)}}, s) == all);
  CHECK(s.bonds[4].place == place);
  CHECK(s.bonds[7].place == place);
}
