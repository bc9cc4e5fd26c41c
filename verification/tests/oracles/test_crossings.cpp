// Moving features and crossings of meshes: against distances in 50 digits, all pairs of triangles,
// and hand-made configurations.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <limits>
#include <random>

#include "verification/oracles/crossing_subdivision.h"
#include "verification/oracles/exact_crossings.h"
#include "verification/oracles/exact_geometry.h"
#include "verification/oracles/feature_distance.h"

using namespace foldproof;
using namespace foldproof::oracles;

namespace {

constexpr Features vertex = Features::vertex_and_triangle, edges = Features::edge_and_edge;
constexpr double last_bit = std::numeric_limits<double>::epsilon();
const Vector3 still(0, 0, 0);

FourPoints points(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) {
  FourPoints x;
  x << a, b, c, d;
  return x;
}

/// The first point moves by `displacement` [m] over a triangle in the plane z = 0 with corners (0,
/// 0), (4, 0), (0, 4).
ExactMotion vertex_over_triangle(const Vector3& from, const Vector3& displacement) {
  return exact_motion(points(from, {0, 0, 0}, {4, 0, 0}, {0, 4, 0}),
                      points(displacement, still, still, still));
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

}  // namespace

TEST_CASE("features meet just where their distance is zero") {
  std::mt19937 bits(29);
  int meetings = 0;
  for (int k = 0; k < 20000; ++k) {
    std::uniform_int_distribution<int> coordinate(k % 2 == 0 ? -1 : -3, k % 2 == 0 ? 1 : 3);
    FourPoints x;
    for (double& c : x.reshaped()) c = coordinate(bits);
    for (const Features kind : {vertex, edges}) {
      const bool is_met = meet(kind, x);
      meetings += is_met;
      REQUIRE(is_met == (feature_distance(kind, x).value == 0));
    }
  }
  CHECK(meetings > 3000);
}

TEST_CASE("a vertex hits a triangle within, on its border, at either end of the time, or not") {
  struct Row {
    Vector3 from, displacement;
    bool hits;
  };
  for (const auto& [from, displacement, hits] :
       {Row{{1, 1, 3}, {0, 0, -7}, true}, Row{{1, 1, 3}, {0, 0, -3}, true},  // at t = 1
        Row{{1, 1, 3}, {0, 0, -3 * (1 - last_bit)}, false},
        Row{{1, 1, 0}, {0, 0, 5}, true},   // at t = 0
        Row{{2, 2, 1}, {0, 0, -3}, true},  // on an edge
        Row{{2, 2 * (1 + last_bit), 1}, {0, 0, -3}, false},
        Row{{4, 0, 1}, {0, 0, -3}, true},   // on a corner
        Row{{-1, 5, 0}, {3, -4, 0}, true},  // in the plane: through
        Row{{-1, 4, 0}, {3, 0, 0}, true},   // past a corner, touching it
        Row{{-1, 4 * (1 + last_bit), 0}, {3, 0, 0}, false},
        Row{{1, 2, 0}, {0, 0, 0}, true},  // at rest, within
        Row{{3, 2, 0}, {0, 0, 0}, false}}) {
    CHECK(ever_meet(vertex, vertex_over_triangle(from, displacement)) == hits);
  }
  const ExactMotion motion = vertex_over_triangle({1, 1, 3}, {0, 0, -6});
  CHECK(ever_meet(vertex, until(motion, 0.5)));
  CHECK_FALSE(ever_meet(vertex, until(motion, std::nextafter(0.5, 0))));
  CHECK_FALSE(ever_meet(vertex, until(motion, 0)));
}

TEST_CASE("degenerate features meet as what is left of them") {
  const Vector3 o(0, 0, 0);
  const FourPoints line = points({1, -1, 0}, o, {4, 0, 0}, {2, 0, 0}),  // a triangle: a segment
      dot = points({1, 1, 1}, {1, 1, 1}, o, o),                         // edges: points
      parallel = points({0, 0, 1}, {2, 0, 1}, {2, 0, 0}, {5, 0, 0});
  const auto first_two = [](const Vector3& way) { return points(way, way, still, still); };
  for (const double off : {0, 1}) {
    const bool meets = off == 0;
    CHECK(ever_meet(vertex, exact_motion(line, points({0, 3, off}, still, still, still))) == meets);
    CHECK(ever_meet(edges, exact_motion(dot, first_two({-3, -3, -3 + off}))) == meets);
    CHECK(ever_meet(edges, exact_motion(parallel, first_two({-off, 0, -3}))) == meets);
  }
}

TEST_CASE("halved times decide what is plain, and say when they cannot") {
  const auto over = [](const Vector3& from, const Vector3& way, int halvings) {
    return decide_by_subdivision(vertex, vertex_over_triangle(from, way), halvings);
  };
  CHECK(over({1, 1, 3}, {0, 0, -7}, 0) == MeetDecision::meet);
  CHECK(over({1, 1, 3}, {0, 0, -2}, 0) == MeetDecision::apart);
  CHECK(over({1, 1, 3}, {0, 0, -3}, 6) == MeetDecision::unclear);  // just reaches it
  // through the plane while above the triangle in the middle of its way only
  CHECK(over({-4, 1, 4}, {10, 0, -9}, 0) == MeetDecision::unclear);
  CHECK(over({-4, 1, 4}, {10, 0, -9}, 5) == MeetDecision::meet);
}

TEST_CASE("a motion between fractions has each of their numbers, over one denominator") {
  const std::array<long, 3> denominators{2, 3, 5};
  const auto numerator = [](std::size_t point, std::size_t axis) {
    return long(7 * point + 3 * axis) - 11;
  };
  std::array<std::array<Fraction, 3>, 8> x;
  for (std::size_t i = 0; i < 8; ++i)
    for (std::size_t k = 0; k < 3; ++k) x[i][k] = {numerator(i, k), denominators[k]};
  const ExactMotion motion = motion_between(x);
  const auto whole = [&](std::size_t point, std::size_t axis) {
    return 30 / denominators[axis] * numerator(point, axis);
  };
  for (std::size_t i = 0; i < 4; ++i) {
    const Exact &p = motion.start[i], &way = motion.displacement[i];
    const std::array<Whole, 3> start{p.x, p.y, p.z}, displacement{way.x, way.y, way.z};
    for (std::size_t k = 0; k < 3; ++k) {
      CHECK(start[k] == whole(i, k));
      CHECK(displacement[k] == whole(i + 4, k) - whole(i, k));
    }
  }
}

TEST_CASE("an edge crosses a triangle, touches it, or stays clear") {
  const Corners3 t = {Vector3(0, 0, 0), Vector3(4, 0, 0), Vector3(0, 4, 0)},
                 line = {Vector3(0, 0, 0), Vector3(4, 0, 0), Vector3(1, 0, 0)};
  struct Row {
    Vector3 a, b;
    std::size_t pairs;
  };
  for (const auto& [a, b, pairs] :
       {Row{{1, 1, -1}, {1, 1, 2}, 1}, Row{{1, 1, 0}, {1, 1, 2}, 1},  // an end within
        Row{{2, 2, -1}, {2, 2, 2}, 1},                                // through a side
        Row{{4, 0, -1}, {4, 0, 2}, 1},                                // through a corner
        Row{{2, 2, 0}, {5, 5, 0}, 1},                                 // flat, touching
        Row{{-1, 1, 0}, {5, 1, 0}, 1}, Row{{1, 0, 0}, {3, 0, 0}, 1},  // flat, along a side
        Row{{2, 2 * (1 + last_bit), -1}, {2, 2 * (1 + last_bit), 2}, 0},
        Row{{1, 1, last_bit}, {1, 1, 2}, 0}, Row{{3, 2, 0}, {5, 5, 0}, 0},
        Row{{5, 0, 0}, {7, 0, 0}, 0}}) {
    CHECK(pairs_of_edge(a, b, t) == pairs);
  }
  CHECK(pairs_of_edge({3, -1, 0}, {3, 2, 0}, line) == 1);
  CHECK(pairs_of_edge({3, -1, 1}, {3, 2, 1}, line) == 0);
}

TEST_CASE("neighbours are counted when one is folded onto the other, not side by side") {
  const auto hinge = [](const Vector3& tip) {  // triangles on both sides of the edge 0 1
    return exact_crossings(columns({{0, 0, 0}, {4, 0, 0}, {1, 3, 0}, tip}), {{0, 1, 2}, {1, 0, 3}})
        .size();
  };
  for (const auto& [tip, count] : std::vector<std::pair<Vector3, std::size_t>>{
           {{1, -3, 0}, 0},
           {{1, 2, 1}, 0},
           {{1, 2, last_bit}, 0},
           {{1, 2, 0}, 2},   // the tip in the other triangle, so both of its edges
           {{1, 3, 0}, 4},   // one on the other: two edges each
           {{3, 3, 0}, 2}})  // 0 3 and 1 2 cross, neither tip is in the other triangle
    CHECK(hinge(tip) == count);
}
