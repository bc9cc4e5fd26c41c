// The equation of a whole sheet: what it refuses, and energies and motions written out.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "verification/oracles/cloth.h"
#include "verification/oracles/driven_hinge.h"
#include "verification/tests/hinge_specimens.h"

using namespace foldproof;
using namespace foldproof::oracles;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

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

/// What the equation of the edited specimen throws; nothing: an empty text.
template <class Edit>
std::string complaint(const Edit& edit) {
  ClothDefinition cloth = specimen();
  edit(cloth);
  try {
    cloth_rhs(cloth);
  } catch (const InputError& error) {
    try {
      mechanical_energy(cloth, specimen_state());
    } catch (const InputError& other) {
      CHECK(std::string(other.what()) == error.what());
      return error.what();
    }
    return "not of the energy";
  }
  return "";
}

}  // namespace

TEST_CASE("the sheet's equation names the entry that it refuses") {
  CHECK(complaint([](ClothDefinition&) {}).empty());
  for (const double mass : {0., -1., double(NAN)})
    CHECK(complaint([&](ClothDefinition& cloth) { cloth.masses[3] = mass; }) ==
          "oracle cloth: mass 3 must be positive");
  const auto with_spring = [](const SpringDefinition& spring) {
    return complaint([&](ClothDefinition& cloth) { cloth.springs[1] = spring; });
  };
  CHECK(with_spring({5, 1, 1.3, .29}) == "oracle cloth: spring 1 names particle 5 of 5");
  CHECK(with_spring({2, -1, 1.3, .29}) == "oracle cloth: spring 1 names particle -1 of 5");
  CHECK(with_spring({0, 4, 1.3, .29}).empty());
  CHECK(with_spring({2, 2, 1.3, .29}) == "oracle cloth: spring 1 must have two different ends");
  for (const auto& [length, area] : {std::pair{0., .29}, {1.3, 0.}, {-1.3, -.29}, {NAN, .29}})
    CHECK(with_spring({4, 1, length, area}) ==
          "oracle cloth: spring 1 must have a length and an area");
  const auto with_hinge = [](const HingeDefinition& hinge) {
    return complaint([&](ClothDefinition& cloth) { cloth.hinges.push_back(hinge); });
  };
  CHECK(with_hinge({{1, 2, 3, 4}, .3, 1.9, .8}).empty());
  CHECK(with_hinge({{1, 2, 3, 5}, .3, 1.9, .8}) == "oracle cloth: hinge 1 names particle 5 of 5");
  CHECK(with_hinge({{-2, 2, 3, 4}, .3, 1.9, .8}) == "oracle cloth: hinge 1 names particle -2 of 5");
  for (const auto& [anisotropy, edge] : {std::pair{0., .8}, {1.9, 0.}, {-1.9, -.8}, {1.9, NAN}})
    CHECK(with_hinge({{1, 2, 3, 4}, .3, anisotropy, edge}) ==
          "oracle cloth: hinge 1 must have positive factors at rest");
  CHECK(complaint([](ClothDefinition& cloth) {
          cloth.prescribed[5] = fixed_motion({1, 2, 3});
        }) == "oracle cloth: a prescribed motion names particle 5 of 5");
  CHECK(complaint([](ClothDefinition& cloth) {
          cloth.prescribed[4] = fixed_motion({1, 2, 3});
        }).empty());
  CHECK(complaint([](ClothDefinition& cloth) {
          cloth.prescribed[2] = fixed_motion({1, 2, 3});
          cloth.prescribed[2].x = nullptr;
        }) == "oracle cloth: the motion of particle 2 must have x and v");
  CHECK(complaint([](ClothDefinition& cloth) {
          cloth.prescribed[2] = fixed_motion({1, 2, 3});
          cloth.prescribed[2].v = nullptr;
        }) == "oracle cloth: the motion of particle 2 must have x and v");
  CHECK(complaint([](ClothDefinition& cloth) { cloth.gravity.y() = infinity; }) ==
        "oracle cloth: gravity must be finite");
  CHECK(complaint([](ClothDefinition& cloth) {
          for (int i = 0; i < 5; ++i) cloth.prescribed[i] = fixed_motion({1, 2, 3});
        }) == "oracle cloth: at least one particle must be free");
}

TEST_CASE("a hinge at rest needs corners that exist and triangles with an area") {
  PerParticle3 rest(3, 5);
  rest << 0, 0, 1, 2, 3, 0, 3, 0, 0, 5, 1, 1, 1, 1, 1;  // 0, 2, 3 lie on a line
  const std::string missing =
                        "oracle cloth: hinge_at_rest: a corner is not among the rest positions",
                    flat = "oracle cloth: hinge_at_rest: both triangles must have an area";
  CHECK_THROWS_WITH(hinge_at_rest({1, 4, 2, 5}, rest, .1), missing);
  CHECK_THROWS_WITH(hinge_at_rest({-1, 4, 2, 3}, rest, .1), missing);
  CHECK_THROWS_WITH(hinge_at_rest({0, 4, 2, 3}, rest, .1), flat);
  CHECK_THROWS_WITH(hinge_at_rest({1, 0, 2, 3}, rest, .1), flat);
  const HingeDefinition hinge = hinge_at_rest({1, 4, 2, 3}, rest, .1);
  // the edge is 1 long, the corners 3 and 5 off its line
  CHECK(hinge.corners == std::array{1, 4, 2, 3});
  CHECK(hinge.rest_angle == .1);
  CHECK(hinge.rest_edge_length == Approx(1).epsilon(1e-15));
  CHECK(hinge.rest_anisotropy == Approx(1. / 8).epsilon(1e-15));
  CHECK(hinge_at_rest({0, 4, 1, 2}, rest, .1).corners[0] == 0);  // the first corner exists
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
  std::vector<double> longer = y, shorter = y;
  longer.push_back(1);
  shorter.pop_back();
  for (const std::vector<double>& wrong : {longer, shorter})
    CHECK_THROWS_WITH(cloth_state(cloth, 0, wrong),
                      "oracle cloth: cloth_state: y must have 6 numbers a free particle");
  const std::string columns = "oracle cloth: free_coordinates: x and v must have one column a mass";
  CHECK_THROWS_WITH(free_coordinates(cloth, {state.x.leftCols(4), state.v}), columns);
  CHECK_THROWS_WITH(free_coordinates(cloth, {state.x, state.v.leftCols(4)}), columns);
}

TEST_CASE("the energy of a sheet is the sum of its particles', springs' and hinges'") {
  const ClothDefinition cloth = specimen();
  const ClothState state = specimen_state();
  double expected = 0;
  for (int i = 0; i < 5; ++i) {
    const double m = cloth.masses[std::size_t(i)];
    expected += m / 2 * state.v.col(i).squaredNorm() - m * cloth.gravity.dot(state.x.col(i));
  }
  for (const auto& [a, b, length, area] : {std::tuple{0, 3, .9, .17}, std::tuple{4, 1, 1.3, .29}})
    expected += 53 * area / 2 * std::pow((state.x.col(b) - state.x.col(a)).norm() / length - 1, 2);
  const double theta = hinge_angle_50(first_hinge().x).value;
  expected += .0037 * 1.9 *
              (2 * (std::cos(.37 / 2) - std::cos(theta / 2)) - std::sin(.37 / 2) * (theta - .37));
  CHECK(mechanical_energy(cloth, state) == Approx(expected).epsilon(1e-14));
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

TEST_CASE("a driven hinge has thirds of its triangles' masses, and springs on five edges") {
  DrivenHinge problem{first_hinge(), .23, 31, .017, Vector3(.4, -.9, -9.8), {}, {}};
  const ClothDefinition cloth = driven_hinge(problem);
  const Corners rest = problem.hinge.rest;
  const double first = (rest[0] - rest[2]).cross(rest[0] - rest[3]).norm() / 2,
               second = (rest[1] - rest[2]).cross(rest[1] - rest[3]).norm() / 2;
  const std::array<double, 4> areas{first, second, first + second, first + second};
  for (std::size_t i = 0; i < 4; ++i)
    CHECK(cloth.masses[i] == Approx(.23 / 3 * areas[i]).epsilon(1e-14));
  REQUIRE(cloth.springs.size() == 5);
  for (const SpringDefinition& spring : cloth.springs) {
    const double area = spring.a == 0 ? first : spring.a == 1 ? second : first + second;
    CHECK(spring.area == Approx(area).epsilon(1e-14));
    CHECK(
        spring.rest_length ==
        Approx((rest[std::size_t(spring.a)] - rest[std::size_t(spring.b)]).norm()).epsilon(1e-15));
  }
  for (const double density : {0., -.1, double(NAN)}) {
    problem.density = density;
    CHECK_THROWS_WITH(driven_hinge(problem), "oracle driven_hinge: density must be positive");
  }
}
