// Springs and their dampers: threads, bounds, and refusals.
#include <catch2/catch.hpp>
#include <cmath>

#include "reference/forces/degenerate.h"
#include "reference/mesh/shapes.h"
#include "verification/tests/reference/forces/force_differences.h"

using namespace foldproof;

TEST_CASE("springs do the same on any number of threads, to the bit") {
  // so many that forces on a particle come from the same and from another thread in turn
  constexpr int particles = 12;
  const State s{0, scattered(particles, 0.4), scattered(particles, 2.9)};
  StretchSprings all_damp;
  for (int k = 0; k < 60; ++k) {
    const int a = (5 * k + 1) % particles, b = (a + 1 + k % 11) % particles;
    all_damp.springs.push_back({a, b, 0.3 + 0.01 * k, 3 + 0.7 * k, 0.1 + 0.03 * k});
  }
  StretchSprings one_does_not = all_damp;
  one_does_not.springs[7].damping = 0;
  const PerParticle3 start = scattered(particles, 5.1);
  const auto results = [&](StretchSprings springs, int threads) {
    springs.set_team(threads, particles);
    PerParticle3 f = start, damped = start;
    PerParticle rows = start.row(0).transpose();
    const SpringShapes shapes = springs.shapes_at(s.x);
    springs.add_elastic(s, shapes, f);
    springs.add_stiffness_bound(s, shapes, rows);
    DampingOperator damping;
    springs.prepare_damping(s, shapes, damping);
    damping.add_product(s.v, damped);
    return std::tuple(f, damped, rows, springs.energy(s, shapes));
  };
  for (const int threads : {2, 3, 6})
    for (const StretchSprings& list : {one_does_not, all_damp})
      CHECK(results(list, threads) == results(list, 1));
}

TEST_CASE("a spring without length is refused with both of its ends, wherever it is used") {
  const StretchSprings list{{{0, 2, 0.3, 13, 0.31}, {3, 1, 0.3, 13, 0.31}}};
  State s{0.37, scattered(4, 0.4), scattered(4, 2.9)};
  s.x.col(1) = s.x.col(3);
  ForceDifferential differential;
  const auto refusal = Catch::Message("a spring has no length (particles 3 1)");
  CHECK_THROWS_MATCHES(list.shapes_at(s.x), DegenerateElement, refusal);
  CHECK_THROWS_MATCHES(list.add_elastic_differential(s, Definiteness::exact, differential),
                       DegenerateElement, refusal);
  CHECK_THROWS_MATCHES(list.add_force_differential(s, differential), DegenerateElement, refusal);
  s.x(2, 0) = std::nan("");
  CHECK_THROWS_WITH(list.shapes_at(s.x), Catch::Contains("particles 0 2"));
}

TEST_CASE("a spring's rows sum to twice the larger of its stiffnesses along and across") {
  // of length 2: pulled, compressed, and compressed to less than half
  for (const auto& [rest, expected] : {std::pair{0.5, 13.0}, {3.0, 13.0}, {5.0, 13 * 1.5}}) {
    State s;
    s.x = PerParticle3{{0, 0, 0}, {0, 2, 0}, {0, 0, 0}};
    PerParticle rows = PerParticle::Ones(3);
    add_stiffness_bound(StretchSprings{{{0, 1, rest, 13, 0.31}}}, s, rows);
    CHECK((rows - Vector3(1 + 2 * expected, 1 + 2 * expected, 1)).norm() < 1e-13);
  }
}

TEST_CASE("springs refuse constants that are negative or no number, and lengths of 0") {
  const TriangleMesh mesh = make_sheet({SheetPattern::one_diagonal, 1.3, 0.7, 1, 1});
  const auto refused = [&](const StretchMaterial& material, const char* why) {
    CHECK_THROWS_WITH(make_springs(mesh, material), Catch::Contains(why));
  };
  for (const double bad : {-1e-300, -3.0, std::nan("")}) {
    refused({bad, 0.4, 0.9}, "stiffness");
    refused({0.4, bad, 0.9}, "damping");
    refused({0.4, 0.3, bad}, "rest_length_scale");
  }
  refused({0.4, 0.3, 0}, "rest_length_scale");
  for (const double good : {0.0, 1e-300, 0.3})
    CHECK(make_springs(mesh, {good, good, 1e-9}).springs.size() == 5);
}
