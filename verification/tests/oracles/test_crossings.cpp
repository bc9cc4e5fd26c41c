// Exact decisions: moving features, crossings of meshes, and sides of bodies.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <limits>

#include "verification/oracles/crossing_subdivision.h"
#include "verification/oracles/exact_crossings.h"
#include "verification/oracles/exact_geometry.h"

using namespace foldproof;
using namespace foldproof::oracles;

namespace {

constexpr Features vertex = Features::vertex_and_triangle;
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

TEST_CASE("a point has no side where no segment from it is clean, or a triangle has no area") {
  const TriangleSoup thin{box_between({0, 0, 0}, {1, 1, 1}).x, {{0, 0, 1}, {0, 1, 2}}};
  CHECK_THROWS_WITH(side_of(thin, {0, 0, 0}), Catch::Contains("without area has no inside"));
  // so small a box about the point (1, 1, 1) that all segments leave it through one corner
  const double step = std::numeric_limits<double>::epsilon(), half = 1 + 2 * step,
               end = 1 + 4 * step;
  CHECK_THROWS_AS(side_of(box_between({1, 1, 1}, {end, end, end}), {half, half, half}),
                  std::runtime_error);
}

TEST_CASE("triangles within a body are found, though they meet no triangle of it") {
  TriangleSoup cloth{PerParticle3(3, 9), {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}}};
  cloth.x.leftCols(3) << 0.1, 0.2, 0.1, 0.1, 0.1, 0.2, 0.15, 0.15, 0.15;       // inside
  cloth.x.middleCols(3, 3) << 0.1, 0.2, 0.1, 0.1, 0.1, 0.2, 0.35, 0.36, 0.37;  // outside
  cloth.x.rightCols(3) << 0.1, 0.2, 0.1, 0.1, 0.1, 0.2, 0.36, 0.3, 0.25;       // through the top
  const TriangleSoup box = box_between({0, 0, 0}, {.3, .3, .3});
  CHECK(triangles_in_body(cloth, box) == std::vector<int>{0, 2});
}

TEST_CASE("a last bit decides on which side of a plane a point is") {
  const Vector3 a(0.1, 0.2, 0.3), b(1.1, 0.2, 0.3), c(0.1, 1.2, 0.3);
  const double above = std::nextafter(0.3, 1);
  CHECK(orientation(a, b, c, {0.7, 0.4, above}) == 1);
  CHECK(orientation(a, b, c, {0.7, 0.4, 0.3}) == 0);
  CHECK(orientation(a, c, b, {0.7, 0.4, above}) == -1);
  const Vector3 far(0, 0, std::numeric_limits<double>::denorm_min());
  // the product underflows in double
  CHECK(orientation({0, 0, 0}, {1e-200, 0, 0}, {0, 1e-200, 0}, far) == 1);
}
