// The equation of a whole sheet: refused entries, and energies and motions written out.
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

#include "verification/oracles/cloth.h"
#include "verification/tests/complaint.h"
#include "verification/tests/hinge_specimens.h"

using namespace foldproof;
using namespace foldproof::oracles;

namespace {

/// Five particles, two springs, and a hinge of the first hinge's corners, in another order.
ClothDefinition specimen() {
  ClothDefinition cloth;
  cloth.masses = {.3, .7, 1.1, .23, .41};
  cloth.springs = {{0, 3, .9, .17}, {4, 1, 1.3, .29}};
  cloth.hinges = {{{3, 0, 4, 2}, .37, 1.9, .83}};
  cloth.material.young = 53;
  cloth.material.spring_damping = .31;
  cloth.material.bending_stiffness = .0037;
  cloth.material.bending_damping = .00041;
  cloth.gravity = Vector3(.4, -.9, -9.7);
  return cloth;
}

ClothState specimen_state() {
  const HingeInput hinge = first_hinge();
  ClothState state{PerParticle3(3, 5), PerParticle3(3, 5)};
  state.x << hinge.x[1], Vector3(.21, .77, -.34), hinge.x[3], hinge.x[0], hinge.x[2];
  state.v << hinge.v[1], Vector3(-.5, .61, .47), hinge.v[3], hinge.v[0], hinge.v[2];
  return state;
}

/// The message of the equation of the edited specimen and of its energy; "" if there is none.
template <class Edit>
std::string complaint_about(const Edit& edit) {
  ClothDefinition cloth = specimen();
  edit(cloth);
  const std::string said = complaint([&] { cloth_rhs(cloth); });
  CHECK(said == complaint([&] { mechanical_energy(cloth, specimen_state()); }));
  return said;
}

}  // namespace

TEST_CASE("the sheet's equation names the entry that it refuses") {
  using Edit = std::function<void(ClothDefinition&)>;
  const auto spring = [](const SpringDefinition& bad) {
    return [bad](ClothDefinition& cloth) { cloth.springs[1] = bad; };
  };
  const auto hinge = [](const HingeDefinition& bad) {
    return [bad](ClothDefinition& cloth) { cloth.hinges.push_back(bad); };
  };
  const auto mass = [](double bad) {
    return [bad](ClothDefinition& cloth) { cloth.masses[3] = bad; };
  };
  const auto hold = [](int first, int last, bool has_x = true, bool has_v = true) {
    return [=](ClothDefinition& cloth) {
      for (int i = first; i <= last; ++i) cloth.prescribed[i] = fixed_motion({1, 2, 3});
      if (!has_x) cloth.prescribed[first].x = nullptr;
      if (!has_v) cloth.prescribed[first].v = nullptr;
    };
  };
  for (const auto& [edit, why] : std::vector<std::pair<Edit, std::string>>{
           {mass(0), "mass 3 must be positive"},
           {mass(NAN), "mass 3 must be positive"},
           {spring({5, 1, 1.3, .29}), "spring 1 names particle 5 of 5"},
           {spring({2, -1, 1.3, .29}), "spring 1 names particle -1 of 5"},
           {spring({0, 4, 1.3, .29}), ""},
           {spring({2, 2, 1.3, .29}), "spring 1 must have two different ends"},
           {spring({4, 1, 0, .29}), "spring 1 must have a length and an area"},
           {spring({4, 1, 1.3, 0}), "spring 1 must have a length and an area"},
           {hinge({{1, 2, 3, 4}, .3, 1.9, .8}), ""},
           {hinge({{1, 2, 3, 5}, .3, 1.9, .8}), "hinge 1 names particle 5 of 5"},
           {hinge({{-2, 2, 3, 4}, .3, 1.9, .8}), "hinge 1 names particle -2 of 5"},
           {hinge({{1, 2, 3, 4}, .3, 0, .8}), "hinge 1 must have positive factors"},
           {hinge({{1, 2, 3, 4}, .3, 1.9, 0}), "hinge 1 must have positive factors"},
           {hold(5, 5), "a prescribed motion names particle 5 of 5"},
           {hold(1, 4), ""},
           {hold(2, 2, false), "the motion of particle 2 must have x and v"},
           {hold(2, 2, true, false), "the motion of particle 2 must have x and v"},
           {hold(0, 4), "at least one particle must be free"},
           {[](ClothDefinition& cloth) { cloth.gravity.y() = INFINITY; }, "gravity must be"}}) {
    INFO(why);
    const std::string said = complaint_about(edit);
    CHECK_THAT(said, Catch::Contains(why));
    CHECK(said.empty() == why.empty());
  }
}

TEST_CASE("coordinates of free particles skip the prescribed ones, and come back") {
  ClothDefinition cloth = specimen();
  cloth.prescribed[1] = harmonic_motion({{.1, .2, .3}, {.4, .5, .6}, 1.7, .8});
  cloth.prescribed[3] = fixed_motion({7, 8, 9});
  const ClothState state = specimen_state();
  const std::vector<double> y = free_coordinates(cloth, state);
  REQUIRE(y.size() == 18);
  const std::array<int, 3> free{0, 2, 4};
  for (std::size_t i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) {
      CHECK(y[3 * i + std::size_t(k)] == state.x(k, free[i]));
      CHECK(y[9 + 3 * i + std::size_t(k)] == state.v(k, free[i]));
    }
  const ClothState back = cloth_state(cloth, .43, y);
  for (const int i : free) {
    CHECK(back.x.col(i) == state.x.col(i));
    CHECK(back.v.col(i) == state.v.col(i));
  }
  CHECK(Vector3(back.x.col(3)) == Vector3(7, 8, 9));
  CHECK(back.v.col(3).isZero(0));
  const double angle = 2 * pi * 1.7 * .43 + .8;
  CHECK((back.x.col(1) - Vector3(.1, .2, .3) - std::sin(angle) * Vector3(.4, .5, .6)).norm() <
        1e-14);
  CHECK((back.v.col(1) - 2 * pi * 1.7 * std::cos(angle) * Vector3(.4, .5, .6)).norm() < 1e-13);
  for (const std::size_t size : {17, 19})
    CHECK_THROWS_WITH(cloth_state(cloth, 0, std::vector<double>(size)),
                      Catch::Contains("6 numbers a free particle"));
  for (const ClothState& wrong :
       {ClothState{state.x.leftCols(4), state.v}, ClothState{state.x, state.v.leftCols(4)}})
    CHECK_THROWS_WITH(free_coordinates(cloth, wrong), Catch::Contains("one column a mass"));
}

TEST_CASE("free particles of a sheet obey Newton's second law, pushed by particle and time") {
  ClothDefinition cloth;
  cloth.masses = {.3, .7, 1.1};
  cloth.springs = {{2, 0, .9, .17}};
  cloth.material.young = 53;
  cloth.material.spring_damping = .31;
  cloth.gravity = Vector3(.4, -.9, -9.7);
  cloth.external_force = [](int particle, double t) {
    return Vector3(particle + .5, t, particle * t);
  };
  cloth.prescribed[0] = harmonic_motion({{.1, .2, .3}, {.4, .5, .6}, .7, .8});
  const double t = .29, angle = 2 * pi * .7 * t + .8;
  const Vector3 x0 = Vector3(.1, .2, .3) + std::sin(angle) * Vector3(.4, .5, .6),
                v0 = 2 * pi * .7 * std::cos(angle) * Vector3(.4, .5, .6);
  const std::array<double, 12> y{1.1, -.4, .6, 2.3, .9, -.7, .31, .53, -.29, -.83, .47, .61};
  std::array<double, 12> dy;
  cloth_rhs(cloth)(t, y, dy);
  for (std::size_t k = 0; k < 6; ++k) CHECK(dy[k] == y[6 + k]);
  const Vector3 d = x0 - Vector3(2.3, .9, -.7), n = d.normalized(),
                closing = v0 - Vector3(-.83, .47, .61);
  const Vector3 spring =
      (53 * .17 / .9 * (d.norm() / .9 - 1) + .31 * .17 / (.9 * .9) * closing.dot(n)) * n;
  const Vector3 first = cloth.gravity + Vector3(1.5, t, t) / .7,
                second = cloth.gravity + (spring + Vector3(2.5, t, 2 * t)) / 1.1;
  for (int k = 0; k < 3; ++k) {
    CHECK(dy[std::size_t(6 + k)] == Approx(first[k]).epsilon(1e-14));
    CHECK(dy[std::size_t(9 + k)] == Approx(second[k]).epsilon(1e-14));
  }
}
