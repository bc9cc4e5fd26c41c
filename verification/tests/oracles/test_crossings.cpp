// The exact judges of crossings: against distances in 50 digits, against halved times, against
// hand-made configurations.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <limits>
#include <random>

#include "verification/oracles/crossing_subdivision.h"
#include "verification/oracles/exact_crossings.h"
#include "verification/oracles/exact_geometry.h"
#include "verification/oracles/feature_distance.h"
#include "verification/oracles/whole_polynomial.h"

using namespace foldproof;
using namespace foldproof::oracles;

namespace {

constexpr Features kinds[] = {Features::vertex_and_triangle, Features::edge_and_edge};

FourPoints small_points(std::mt19937& bits, int largest) {
  std::uniform_int_distribution<int> coordinate(-largest, largest);
  FourPoints x;
  for (double& c : x.reshaped()) c = coordinate(bits);
  return x;
}

FourPoints points(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) {
  FourPoints x;
  x << a, b, c, d;
  return x;
}

/// The first point moves by `displacement` [m] over a triangle in the plane z = 0 with corners (0,
/// 0), (4, 0), (0, 4).
Motion vertex_over_triangle(const Vector3& from, const Vector3& displacement) {
  return exact_motion(points(from, {0, 0, 0}, {4, 0, 0}, {0, 4, 0}),
                      points(displacement, Vector3::Zero(), Vector3::Zero(), Vector3::Zero()));
}

bool vertex_hits(const Vector3& from, const Vector3& displacement) {
  return ever_meet(Features::vertex_and_triangle, vertex_over_triangle(from, displacement));
}

PerParticle3 columns(std::initializer_list<Vector3> list) {
  PerParticle3 x(3, Eigen::Index(list.size()));
  Eigen::Index i = 0;
  for (const Vector3& p : list) x.col(i++) = p;
  return x;
}

/// A lone triangle 3 4 5 with an edge 0 1 of another, whose corner 2 is far off.
std::size_t pairs_of_edge(const Vector3& a, const Vector3& b, const Corners3& t) {
  const PerParticle3 x = columns({a, b, {50, 60, 70}, t[0], t[1], t[2]});
  std::size_t pairs = 0;
  for (const EdgeInTriangle& found : exact_crossings(x, {{0, 1, 2}, {3, 4, 5}}))
    pairs += found.edge == std::array<int, 2>{0, 1};
  return pairs;
}

constexpr double last_bit = std::numeric_limits<double>::epsilon();

}  // namespace

TEST_CASE("signs at roots that no fraction is") {
  const Polynomial p({-1, 0, 2});  // 2 t^2 - 1
  REQUIRE(roots_within(p).size() == 1);
  const Root root = roots_within(p)[0];
  CHECK(sign_at(Polynomial({-707106781, 1000000000}), root) == 1);
  CHECK(sign_at(Polynomial({-707106782, 1000000000}), root) == -1);
  CHECK(sign_at(p * Polynomial({3, 5}), root) == 0);
  CHECK(sign_at(Polynomial({-7}), root) == -1);
  const Polynomial twice = p * p * Polynomial({-1, 3});  // the root again, twofold, and one at 1/3
  REQUIRE(roots_within(twice).size() == 2);
  CHECK(sign_at(p, roots_within(twice)[0]) == -1);
  CHECK(sign_at(p, roots_within(twice)[1]) == 0);
}

TEST_CASE("roots at the ends are not between them, and fractions of two do not disturb") {
  const Polynomial t({0, 1}), rest({1, -1}), half({-1, 2}), quarter({-1, 4});
  CHECK(roots_within(t * rest).empty());
  CHECK(roots_within(t * t * rest * half).size() == 1);
  CHECK(roots_within(half * quarter * Polynomial({-3, 4})).size() == 3);
  CHECK(roots_within(Polynomial({1, 0, 1})).empty());
  CHECK_THROWS_AS(roots_within(Polynomial()), std::invalid_argument);
}

TEST_CASE("features meet just where their distance is zero") {
  std::mt19937 bits(29);
  int meetings = 0;
  for (int k = 0; k < 20000; ++k) {
    const FourPoints x = small_points(bits, k % 2 == 0 ? 1 : 3);
    for (const Features kind : kinds) {
      const bool is_met = meet(kind, x);
      meetings += is_met;
      REQUIRE(is_met == (feature_distance(kind, x).value == 0));
    }
  }
  CHECK(meetings > 3000);
}

TEST_CASE("roots and halved times agree on who ever meets") {
  std::mt19937 bits(31);
  int meetings = 0, unclear = 0;
  for (int k = 0; k < 4000; ++k) {
    const FourPoints x = small_points(bits, 9),
                     displacement = small_points(bits, k % 2 == 0 ? 9 : 3);
    for (const Features kind : kinds) {
      const Motion motion = exact_motion(x, displacement);
      const bool ever = ever_meet(kind, motion);
      const MeetDecision seen = decide_by_subdivision(kind, motion, 8);
      meetings += seen == MeetDecision::meet;
      unclear += seen == MeetDecision::unclear;
      if (seen != MeetDecision::unclear) REQUIRE(ever == (seen == MeetDecision::meet));
    }
  }
  CHECK(meetings > 300);
  CHECK(unclear < 300);
}

TEST_CASE("a vertex hits a triangle within, on its border, at either end of the time, or not") {
  CHECK(vertex_hits({1, 1, 3}, {0, 0, -7}));
  CHECK(vertex_hits({1, 1, 3}, {0, 0, -3}));  // at t = 1
  CHECK_FALSE(vertex_hits({1, 1, 3}, {0, 0, -3 * (1 - last_bit)}));
  CHECK(vertex_hits({1, 1, 0}, {0, 0, 5}));   // at t = 0
  CHECK(vertex_hits({2, 2, 1}, {0, 0, -3}));  // on an edge
  CHECK_FALSE(vertex_hits({2, 2 * (1 + last_bit), 1}, {0, 0, -3}));
  CHECK(vertex_hits({4, 0, 1}, {0, 0, -3}));   // on a corner
  CHECK(vertex_hits({-1, 5, 0}, {3, -4, 0}));  // in the plane: through
  CHECK(vertex_hits({-1, 4, 0}, {3, 0, 0}));   // past a corner, touching it
  CHECK_FALSE(vertex_hits({-1, 4 * (1 + last_bit), 0}, {3, 0, 0}));
  CHECK(vertex_hits({1, 2, 0}, {0, 0, 0}));  // at rest, within
  CHECK_FALSE(vertex_hits({3, 2, 0}, {0, 0, 0}));
}

TEST_CASE("degenerate features meet as what is left of them") {
  const Vector3 o(0, 0, 0), still(0, 0, 0);
  // a triangle that is a segment
  const FourPoints line = points({1, -1, 0}, o, {4, 0, 0}, {2, 0, 0});
  CHECK(ever_meet(Features::vertex_and_triangle,
                  exact_motion(line, points({0, 3, 0}, still, still, still))));
  CHECK_FALSE(ever_meet(Features::vertex_and_triangle,
                        exact_motion(line, points({0, 3, 1}, still, still, still))));
  const FourPoints dot = points({1, 1, 1}, {1, 1, 1}, o, o);  // edges that are points
  CHECK(ever_meet(Features::edge_and_edge,
                  exact_motion(dot, points({-3, -3, -3}, {-3, -3, -3}, still, still))));
  CHECK_FALSE(ever_meet(Features::edge_and_edge,
                        exact_motion(dot, points({-3, -3, -2}, {-3, -3, -2}, still, still))));
  const FourPoints parallel = points({0, 0, 1}, {2, 0, 1}, {2, 0, 0}, {5, 0, 0});
  CHECK(ever_meet(Features::edge_and_edge,
                  exact_motion(parallel, points({0, 0, -3}, {0, 0, -3}, still, still))));
  CHECK_FALSE(ever_meet(Features::edge_and_edge,
                        exact_motion(parallel, points({-1, 0, -3}, {-1, 0, -3}, still, still))));
}

TEST_CASE("the part of a motion before a time is judged to the last bit") {
  const Motion motion = vertex_over_triangle({1, 1, 3}, {0, 0, -6});
  CHECK(ever_meet(Features::vertex_and_triangle, until(motion, 0.5)));
  CHECK_FALSE(ever_meet(Features::vertex_and_triangle, until(motion, std::nextafter(0.5, 0))));
  CHECK_FALSE(ever_meet(Features::vertex_and_triangle, until(motion, 0)));
}

TEST_CASE("fractions are exact: a third of the way") {
  std::array<std::array<Fraction, 3>, 8> x;
  x.fill({Fraction{0, 1}, Fraction{0, 1}, Fraction{0, 1}});
  x[0] = x[4] = {Fraction{1, 3}, Fraction{1, 3}, Fraction{1, 7}};
  x[4][2] = {-1, 5};
  // (1/3, 1/3) is on the edge from (2/3, 0) to (0, 2/3)
  x[2][0] = x[6][0] = x[3][1] = x[7][1] = {2, 3};
  CHECK(ever_meet(Features::vertex_and_triangle, motion_between(x)));
  x[0][0] = x[4][0] = {333333334, 1000000000};
  CHECK_FALSE(ever_meet(Features::vertex_and_triangle, motion_between(x)));
}

TEST_CASE("a motion between fractions has each of their numbers, over one denominator") {
  const std::array<long, 3> denominators{2, 3, 5};
  const auto numerator = [](std::size_t point, std::size_t axis) {
    return long(7 * point + 3 * axis) - 11;
  };
  std::array<std::array<Fraction, 3>, 8> x;
  for (std::size_t i = 0; i < 8; ++i)
    for (std::size_t k = 0; k < 3; ++k) x[i][k] = {numerator(i, k), denominators[k]};
  const Motion motion = motion_between(x);
  const auto whole = [&](std::size_t point, std::size_t axis) {
    return 30 / denominators[axis] * numerator(point, axis);
  };
  for (std::size_t i = 0; i < 4; ++i) {
    CHECK(motion.start[i].x == whole(i, 0));
    CHECK(motion.start[i].y == whole(i, 1));
    CHECK(motion.start[i].z == whole(i, 2));
    CHECK(motion.displacement[i].x == whole(i + 4, 0) - whole(i, 0));
    CHECK(motion.displacement[i].y == whole(i + 4, 1) - whole(i, 1));
    CHECK(motion.displacement[i].z == whole(i + 4, 2) - whole(i, 2));
  }
}

TEST_CASE("an edge crosses a triangle, touches it, or stays clear") {
  const Corners3 t = {Vector3(0, 0, 0), Vector3(4, 0, 0), Vector3(0, 4, 0)};
  CHECK(pairs_of_edge({1, 1, -1}, {1, 1, 2}, t) == 1);
  CHECK(pairs_of_edge({1, 1, 0}, {1, 1, 2}, t) == 1);   // an end within
  CHECK(pairs_of_edge({2, 2, -1}, {2, 2, 2}, t) == 1);  // through a side
  CHECK(pairs_of_edge({4, 0, -1}, {4, 0, 2}, t) == 1);  // through a corner
  CHECK(pairs_of_edge({2, 2, 0}, {5, 5, 0}, t) == 1);   // flat, touching from outside
  CHECK(pairs_of_edge({-1, 1, 0}, {5, 1, 0}, t) == 1);  // flat, through
  CHECK(pairs_of_edge({1, 0, 0}, {3, 0, 0}, t) == 1);   // along a side
  CHECK(pairs_of_edge({2, 2 * (1 + last_bit), -1}, {2, 2 * (1 + last_bit), 2}, t) == 0);
  CHECK(pairs_of_edge({1, 1, last_bit}, {1, 1, 2}, t) == 0);
  CHECK(pairs_of_edge({3, 2, 0}, {5, 5, 0}, t) == 0);
  CHECK(pairs_of_edge({5, 0, 0}, {7, 0, 0}, t) == 0);
  const Corners3 line = {Vector3(0, 0, 0), Vector3(4, 0, 0), Vector3(1, 0, 0)};
  CHECK(pairs_of_edge({3, -1, 0}, {3, 2, 0}, line) == 1);
  CHECK(pairs_of_edge({3, -1, 1}, {3, 2, 1}, line) == 0);
}

TEST_CASE("neighbours are counted when one is folded onto the other, not side by side") {
  const auto hinge = [](const Vector3& tip) {  // triangles on both sides of the edge 0 1
    return exact_crossings(columns({{0, 0, 0}, {4, 0, 0}, {1, 3, 0}, tip}), {{0, 1, 2}, {1, 0, 3}})
        .size();
  };
  CHECK(hinge({1, -3, 0}) == 0);
  CHECK(hinge({1, 2, 1}) == 0);
  CHECK(hinge({1, 2, last_bit}) == 0);
  CHECK(hinge({1, 2, 0}) == 2);  // the tip in the other triangle, so both of its edges
  CHECK(hinge({1, 3, 0}) == 4);  // one on the other: two edges each
  CHECK(hinge({3, 3, 0}) == 2);  // 0 3 and 1 2 cross, neither tip is in the other triangle
}

TEST_CASE("crossings are found as all pairs of triangles say") {
  std::mt19937 bits(37);
  std::uniform_int_distribution<int> coordinate(-3, 3);
  int meetings = 0;
  for (int k = 0; k < 300; ++k) {
    PerParticle3 x(3, 18);
    for (double& c : x.reshaped()) c = coordinate(bits);
    std::vector<std::array<int, 3>> triangles;
    for (int i = 0; i < 18; i += 3) triangles.push_back({i, i + 1, i + 2});
    std::vector<std::array<int, 2>> met, expected;
    for (const EdgeInTriangle& found : exact_crossings(x, triangles)) {
      const auto [s, t] = std::minmax({found.edge[0] / 3, found.triangle});
      met.push_back({s, t});
    }
    std::sort(met.begin(), met.end());
    met.erase(std::unique(met.begin(), met.end()), met.end());
    bool has_lines = false;
    const auto corner = [&](int t) {
      return Corners3{x.col(3 * t), x.col(3 * t + 1), x.col(3 * t + 2)};
    };
    for (int t = 0; t < 6; ++t)
      has_lines |= (corner(t)[1] - corner(t)[0]).cross(corner(t)[2] - corner(t)[0]).isZero(0);
    if (has_lines) continue;  // not for triangles_meet
    for (int s = 0; s < 6; ++s)
      for (int t = s + 1; t < 6; ++t)
        if (triangles_meet(corner(s), corner(t))) expected.push_back({s, t});
    meetings += int(expected.size());
    REQUIRE(met == expected);
  }
  CHECK(meetings > 300);
}

TEST_CASE("a position that is not finite is refused") {
  CHECK_THROWS_AS(exact_crossings(columns({{0, 0, 0}, {NAN, 0, 0}, {0, 1, 0}}), {{0, 1, 2}}),
                  std::invalid_argument);
}
