// Bonds of sticking: where they form, when they break, and in what order they are kept.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <tuple>

#include "reference/forces/sticking.h"
#include "reference/forces/triangle_frame.h"
#include "reference/mesh/shapes.h"
#include "verification/tests/reference/forces/force_differences.h"

using namespace foldproof;

namespace {

/// A triangle at rest in the plane z = 0 with two sides of length 1 along the axes.
StickyPatch palm(const std::vector<int>& particles, double near, double far) {
  StickyPatch patch;
  patch.name = "palm";
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

std::vector<Key> keys(const State& s) {
  std::vector<Key> list;
  for (const Bond& bond : s.bonds) list.emplace_back(bond.patch, bond.particle, bond.triangle);
  return list;
}

std::vector<Key> updated(const Sticking& sticking, State& s) {
  sticking.update_bonds(s);
  return keys(s);
}

const double beyond_half = std::nextafter(0.5, 1), beyond_quarter = std::nextafter(0.25, 1);

}  // namespace

TEST_CASE("bonds form within the near distance, at it, and not beyond, where the particle is") {
  // particles 1 and 3 are within reach; 0 and 2 are not, 4 does not stick
  State s = state_of(PerParticle3{{0.25, 0.25, 0.25, 0.5, 0.25},
                                  {0.25, 0.25, 0.25, 0.125, 0.25},
                                  {beyond_quarter, 0.25, -beyond_quarter, -0.125, 0.125}});
  const Sticking sticking{{palm({2, 3, 1, 0}, 0.25, 0.0625)}};
  CHECK(updated(sticking, s) == std::vector<Key>{{0, 1, 0}, {0, 3, 0}});
  CHECK(s.bonds[0].place == Vector3(0.25, 0.25, 0.25));
  CHECK(s.bonds[1].place == Vector3(0.5, 0.125, -0.125));
  // the places are at no distance from the particles, so that a second call changes nothing
  CHECK(updated(sticking, s) == std::vector<Key>{{0, 1, 0}, {0, 3, 0}});
}

TEST_CASE("bonds form on every side of a surface, also where it breaks before its near distance") {
  const std::vector<Vector3> sides{{-0.2, 0.3, 0.1},   {1.15, -0.05, 0.1}, {0.3, -0.2, 0.1},
                                   {-0.05, 1.15, 0.1}, {0.3, 0.3, 0.2},    {0.3, 0.3, -0.2},
                                   {0.6, 0.1, 0.01},   {0.1, 0.6, -0.01}};
  for (const double far : {0.03, 5.0}) {
    PerParticle3 x(3, 8);
    for (int i = 0; i < 8; ++i) x.col(i) = sides[size_t(i)];
    State s = state_of(x);
    CHECK(updated(Sticking{{palm({0, 1, 2, 3, 4, 5, 6, 7}, 0.25, far)}}, s).size() == 8);
    // ten times as far away there is none
    s = state_of(10 * x.leftCols(6));
    CHECK(updated(Sticking{{palm({0, 1, 2, 3, 4, 5}, 0.25, far)}}, s).empty());
  }
}

TEST_CASE("bonds form with all triangles within reach, of cloth but for those of the particle") {
  const TriangleMesh mesh = make_sheet({SheetPattern::alternating, 1.3, 0.7, 6, 4});
  const PerParticle3 x = mesh.rest + 0.1 * scattered(mesh.particles(), 1.7);
  const int n = mesh.particles();
  StickyPatch patch = palm({}, 0.19, 0.03);
  patch.triangles = mesh.triangles;
  for (int i = n - 1; i >= 0; --i)
    if (i % 4 != 1) patch.particles.push_back(i);
  for (const bool is_cloth : {true, false}) {
    patch.place = nullptr, patch.velocity = nullptr;
    if (!is_cloth) {
      patch.place = [x](double) { return x; };
      patch.velocity = [n](double) { return PerParticle3(PerParticle3::Zero(3, n)); };
    }
    State s = state_of(x);
    Sticking{{patch}}.update_bonds(s);
    size_t at = 0;
    for (int i = 0; i < n; ++i)
      for (size_t t = 0; t < mesh.triangles.size() && i % 4 != 1; ++t) {
        const Triangle& names = mesh.triangles[t];
        if (is_cloth && std::ranges::find(names, i) != names.end()) continue;
        const Corners3 corners{x.col(names[0]), x.col(names[1]), x.col(names[2])};
        if ((nearest_on_triangle(corners, x.col(i)).point - x.col(i)).norm() > 0.19) continue;
        REQUIRE(at < s.bonds.size());
        const Bond& bond = s.bonds[at++];
        CHECK(std::tuple(bond.patch, bond.particle, bond.triangle) == Key{0, i, int(t)});
        CHECK((bond.place - local_place(corners, x.col(i))).norm() < 1e-14);
      }
    CHECK(at == s.bonds.size());
    CHECK(at > size_t(n));
  }
}

TEST_CASE("bonds break beyond the far distance, not at it, and each particle's by itself") {
  // all stick to (0.25, 0.25, 0), from distances up to more than 0.5, and too far to bond again
  const Vector3 place(0.25, 0.25, 0);
  State s = state_of(
      PerParticle3{
          {0.25, 0.25, 0.25, 0.25}, {0.25, 0.25, 0.25, 0.25}, {beyond_half, 0.5, -0.375, -0.75}},
      {{0, 0, 0, place}, {0, 0, 1, place}, {0, 0, 2, place}, {0, 0, 3, place}});
  const Sticking sticking{{palm({0, 1, 2, 3}, 0.125, 0.5)}};
  CHECK(updated(sticking, s) == std::vector<Key>{{0, 1, 0}, {0, 2, 0}});
  for (const Bond& bond : s.bonds) CHECK(bond.place == place);
}

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

TEST_CASE("a particle that breaks off bonds again where it is, if a triangle is near") {
  const Vector3 place(0.25, 0.25, 0);
  State s = state_of(PerParticle3{{0.625}, {0.25}, {0.0625}}, {{0, 0, 0, place}});
  CHECK(updated(Sticking{{palm({0}, 0.125, 0.25)}}, s) == std::vector<Key>{{0, 0, 0}});
  CHECK(s.bonds[0].place == Vector3(0.625, 0.25, 0.0625));
}

TEST_CASE("a patch sticks from its beginning on, and at its end no more") {
  StickyPatch early = palm({0}, 0.125, 0.5), late = palm({0}, 0.125, 0.5);
  early.from = 0.3, early.until = 0.7;
  late.from = 0.7, late.until = 1.9;
  const Vector3 at(0.25, 0.25, 0.0625);
  const auto bonds_at = [&](double time, const std::vector<Bond>& bonds) {
    State s = state_of(at, bonds);
    s.time = time;
    return updated(Sticking{{early, late}}, s);
  };
  const std::vector<Bond> both{{0, 0, 0, at}, {1, 0, 0, at}};
  for (const std::vector<Bond>& bonds : {std::vector<Bond>{}, both}) {
    CHECK(bonds_at(std::nextafter(0.3, 0), bonds).empty());
    CHECK(bonds_at(0.3, bonds) == std::vector<Key>{{0, 0, 0}});
    CHECK(bonds_at(std::nextafter(0.7, 0), bonds) == std::vector<Key>{{0, 0, 0}});
    CHECK(bonds_at(0.7, bonds) == std::vector<Key>{{1, 0, 0}});
    CHECK(bonds_at(1.5, bonds) == std::vector<Key>{{1, 0, 0}});
    CHECK(bonds_at(1.9, bonds).empty());
  }
}

TEST_CASE("a particle that sticks to a patch forms no more bonds with it, but does with others") {
  StickyPatch two = palm({1, 0}, 0.125, 0.5);
  two.triangles.push_back({0, 2, 1});
  const Vector3 place(0.3, 0.3, 0.03);
  // bonds are kept by patch, particle and triangle, whatever the order in which they form
  State s = state_of(PerParticle3{{0.25, 0.5}, {0.25, 0.125}, {0.0625, 0.0625}},
                     {{1, 1, 0, place}, {2, 0, 0, place}});
  CHECK(updated(Sticking{{two, two, palm({0, 1}, 0.125, 0.5)}}, s) == std::vector<Key>{{0, 0, 0},
                                                                                       {0, 0, 1},
                                                                                       {0, 1, 0},
                                                                                       {0, 1, 1},
                                                                                       {1, 0, 1},
                                                                                       {1, 1, 0},
                                                                                       {1, 1, 1},
                                                                                       {2, 0, 0},
                                                                                       {2, 1, 0}});
  CHECK(s.bonds[4].place == place);
  CHECK(s.bonds[7].place == place);
}

TEST_CASE("a triangle without area that comes near is refused with its patch and the particle") {
  StickyPatch line = palm({1, 0}, 0.125, 0.5);
  line.place = [](double) { return PerParticle3{{0, 0.25, 0.5}, {0, 0, 0}, {0, 0, 0}}; };
  State s = state_of(PerParticle3{{7, 0.25}, {0, 0}, {0, 0.0625}});
  CHECK_THROWS_WITH(Sticking{{line}}.update_bonds(s),
                    "a triangle of sticky 'palm' has no area (particles 1)");
}
