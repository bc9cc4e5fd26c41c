// The self-collision filter: its impulses, its zones, and tangled cloth.
#include <algorithm>
#include <catch2/catch.hpp>

#include "reference/filters/impact_zones.h"
#include "reference/filters/self_collision.h"
#include "reference/scene/scene.h"
#include "reference/forces/degenerate.h"

using namespace foldproof;

namespace {

SelfCollision filter_of(const TriangleMesh& mesh, const SelfCollisionSettings& settings,
                        const PerParticle& inverse_mass) {
  PerParticle mass = PerParticle::Constant(inverse_mass.size(), 0.8);
  for (Eigen::Index i = 0; i < mass.size(); ++i)
    if (inverse_mass[i] > 0) mass[i] = 1 / inverse_mass[i];
  return {settings, make_cloth_tree(mesh), mass, inverse_mass};
}

State at_rest(const PerParticle3& x) { return {0.3, x, PerParticle3::Zero(3, x.cols())}; }

const Span step{1, 1.1, 0.1};  // moves the cloth
const Span ends{1, 1, 0.1};    // only ends a step

/// A triangle 0-1-2 on the floor, and another that stands on its vertex 3, 0.05 above it.
TriangleMesh dart_over_triangle() {
  PerParticle3 x(3, 6);
  x << 0.1, 1.9, 0.3, 0.6, 0.5, 1.1, 0.2, 0.1, 1.7, 0.7, 0.9, 0.4, 0.4, 0.4, 0.4, 0.45, 1.4, 1.5;
  return make_triangle_mesh(x, {{0, 1, 2}, {3, 4, 5}});
}
/// The dart falls at 1 m/s and moves along at (0.3, 0.4).
PerParticle3 falling_dart() {
  PerParticle3 v = PerParticle3::Zero(3, 6);
  v.rightCols(3).colwise() = Vector3(0.3, 0.4, -1);
  return v;
}
PerParticle with_prescribed_floor() {
  PerParticle w(6);
  w << 0, 0, 0, 0.7, 0.3, 0.9;
  return w;
}

/// The edge 0-1 of the first triangle comes down through the second, 3-4-5, near its side 3-5.
PerParticle3 crossing_triangles() {
  PerParticle3 x(3, 6);
  x << 0.3, 0.4, -3.1, 0, 3.2, 0.1, 0.7, 0.6, 0.8, 0, 0.3, 2.9, 0.9, -0.5, 0.35, 0.1, 0.2, 0.15;
  return x;
}

}  // namespace

TEST_CASE(
    "a fall ends at the thickness, and what only ends a step stops within it, with friction") {
  const TriangleMesh mesh = dart_over_triangle();
  const auto check = [&](double thickness, double friction, const Span& span, const Vector3& after,
                         long close_pairs, long crossings) {
    const SelfCollision filter =
        filter_of(mesh, {thickness, 0, friction, 2, true}, with_prescribed_floor());
    PerParticle3 v = falling_dart(), expected = v;
    expected.col(3) = after;
    Work work;
    filter.correct(span, at_rest(mesh.rest), v, work);
    CHECK((v - expected).norm() < 1e-13);
    CHECK(work.close_pairs == close_pairs);
    CHECK(work.crossings == crossings);
    CHECK(work.zones == 0);
  };
  // moved by 0.04 in 0.1 s; a push of 0.6, and 0.12 of the speed of 0.5 along
  check(0.01, 0.2, step, {0.3 * 0.76, 0.4 * 0.76, -0.4}, 0, 1);
  check(0.06, 0, ends, {0.3, 0.4, 0}, 1, 0);
  check(0.04, 0, ends, {0.3, 0.4, -1}, 0, 0);
}

TEST_CASE("a vertex within the thickness of a rim is stopped before it, not pushed back") {
  // it slides over a triangle that is nearer, so that the rim bears no load
  PerParticle3 x(3, 9), v = PerParticle3::Zero(3, 9);
  x << 0, -1, -1, 0.05, 0.05, 4, -3, 1, -3, 0, 0.3, -0.4, -2, 2, 0, -3, 0, 3, 0.04, 2, 2.2, 0.04,
      0.04, 0.04, 0, 0, 0;
  v(0, 0) = 0.5;
  PerParticle w = PerParticle::Zero(9);
  w.head(3).setConstant(0.7);
  const TriangleMesh mesh = make_triangle_mesh(x, {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}});
  Work work;
  filter_of(mesh, {0.06, 0, 0, 8, true}, w).correct(step, at_rest(x), v, work);
  CHECK(work.crossings == 1);
  CHECK(v.norm() < 1e-13);
}

TEST_CASE("without rounds what meets moves as a zone, and zones are counted with their particles") {
  const TriangleMesh mesh = dart_over_triangle();
  const PerParticle3& x = mesh.rest;
  PerParticle w = with_prescribed_floor();
  for (const bool is_prescribed : {true, false}) {
    if (!is_prescribed) w.head(3) << 0.2, 0.4, 0.6;
    const SelfCollision filter = filter_of(mesh, {0.01, 3, 0.2, 0, true}, w);
    PerParticle3 v = falling_dart();
    v.leftCols(3).row(2).setConstant(-0.125);
    PerParticle3 expected = v;
    // every pair is asked once, and then those with a particle of the zone, but the zone's own
    long queries = long(near_pairs(filter.cloth, x, x + 0.1 * v, 0.002).size());
    Work work;
    work.zones = 10, work.zone_particles = 20;
    filter.correct(step, at_rest(x), v, work);
    move_as_one({0, 1, 2, 3}, x, filter.mass, w, expected);
    CHECK((v - expected).norm() < 1e-13);
    CHECK(work.zones == 11);
    CHECK(work.zone_particles == 24);
    CHECK(work.crossings == 0);
    for (const FeaturePair& pair :
         near_pairs(filter.cloth, x, x + 0.1 * v, 0.002, {1, 1, 1, 1, 0, 0}))
      queries +=
          std::any_of(pair.particles.begin(), pair.particles.end(), [](int i) { return i > 3; });
    CHECK(work.crossing_queries == queries);
  }
}

TEST_CASE(
    "a floor that turns as one takes a zone along; one that is driven into cloth is refused") {
  const TriangleMesh mesh = dart_over_triangle();
  const SelfCollision filter = filter_of(mesh, {0.01, 3, 0.2, 0, true}, with_prescribed_floor());
  const auto turning = [&](Eigen::Index i) {
    return Vector3(Vector3(0.3, -0.2, 0.7) +
                   Vector3(0.05, 0.1, 0.4).cross(Vector3(mesh.rest.col(i))));
  };
  PerParticle3 v = falling_dart();
  for (int i = 0; i < 3; ++i) v.col(i) = turning(i);
  Work work;
  filter.correct(step, at_rest(mesh.rest), v, work);
  CHECK((v.col(3) - turning(3)).norm() < 1e-12);
  CHECK(work.zones == 1);

  PerParticle w = with_prescribed_floor();
  w[3] = 0;
  for (const int rounds : {0, 3}) {
    const SelfCollision driven = filter_of(mesh, {0.01, 3, 0.2, rounds, true}, w);
    PerParticle3 through = falling_dart(), stops = through;
    CHECK_THROWS_AS(driven.correct(step, at_rest(mesh.rest), through, work), DegenerateElement);
    stops(2, 3) = -0.3;  // in time
    CHECK_NOTHROW(driven.correct(step, at_rest(mesh.rest), stops, work));
  }
}

TEST_CASE("particles are tangled in triangles that cross, and pairs whose particles all are go") {
  const std::vector<Triangle> mesh{{0, 1, 2}, {3, 4, 5}, {6, 7, 8}, {2, 9, 10}};
  const std::vector<char> tangled = tangled_particles({{0, 2}}, mesh, 12);
  CHECK(tangled == std::vector<char>{1, 1, 1, 0, 0, 0, 1, 1, 1, 0, 0, 0});
  std::vector<FeaturePair> pairs{{PairKind::edge_edge, {0, 1, 6, 7}},
                                 {PairKind::vertex_triangle, {3, 6, 7, 8}},
                                 {PairKind::vertex_triangle, {1, 6, 7, 8}},
                                 {PairKind::edge_edge, {0, 1, 6, 11}}};
  remove_tangled_pairs(tangled, pairs);
  REQUIRE(pairs.size() == 2);
  CHECK(pairs[0].particles == std::array<int, 4>{3, 6, 7, 8});
  CHECK(pairs[1].particles == std::array<int, 4>{0, 1, 6, 11});
}

TEST_CASE("triangles that do not pierce each other, are fast enough or prescribed are not pushed") {
  const PerParticle3 x = crossing_triangles();
  const PerParticle inverse_mass = PerParticle::Constant(6, 0.3);
  const PerParticle3 rest = PerParticle3::Zero(3, 6);
  const auto pushed = [&](const PerParticle3& at, PerParticle3 v, double speed,
                          const PerParticle& w) {
    push_out_of_tangle({{0, 1}}, {{0, 1, 2}, {3, 4, 5}}, at, speed, w, v);
    return v;
  };
  const PerParticle3 after = pushed(x, rest, 0.3, inverse_mass);
  CHECK(after != rest);
  CHECK(pushed(x, rest, 0.3, PerParticle::Zero(6)) == rest);
  CHECK(pushed(x, 2 * after, 0.29, inverse_mass) == 2 * after);
  for (const Vector3& away : {Vector3(0, 0, 2), Vector3(0, 0, -2), Vector3(-0.6, 0, 0),
                              Vector3(6.5, 0, 0), Vector3(0.5, 3, 0), Vector3(0, -2.5, 0)}) {
    PerParticle3 apart = x;
    apart.leftCols(3).colwise() += away;
    CHECK(pushed(apart, rest, 0.3, inverse_mass) == rest);
  }
}

TEST_CASE("tangled cloth is pushed out a thickness in a hundredth of a second, and let pass") {
  // a third triangle lies close above a corner of the second
  PerParticle3 x(3, 9);
  x << crossing_triangles(), Vector3(0, 0, 0), Vector3(2.8, 1.9, 0.9), Vector3(3.1, 1.8, 1);
  x.col(6) = 0.1 * x.col(3) + 0.8 * x.col(4) + 0.1 * x.col(5) + Vector3(0, 0, 0.02);
  const TriangleMesh mesh = make_triangle_mesh(x, {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}});
  PerParticle w(9);
  w << 0.7, 0.3, 0.9, 0.2, 0.6, 0.4, 0.8, 0.5, 1.1;
  PerParticle3 start = PerParticle3::Zero(3, 9);
  start(2, 6) = -0.4;
  SelfCollision filter = filter_of(mesh, {0.03, 0, 0, 8, true}, w);
  for (const auto& [thickness, span, is_tangled] :
       {std::tuple(0.03, ends, true), std::tuple(0.03, step, true), std::tuple(0.5, ends, true),
        std::tuple(0.03, ends, false)}) {
    filter.settings.thickness = thickness;
    filter.at_start = is_tangled ? CrossingTriangles{{0, 1}} : CrossingTriangles{};
    PerParticle3 v = start, expected = start;
    Work work;
    filter.correct(span, at_rest(x), v, work);
    std::vector<FeaturePair> close = near_pairs(filter.cloth, x, x, thickness);
    const size_t all = close.size();
    if (is_tangled) {  // its close pairs are not repelled: there are some within 0.5
      push_out_of_tangle({{0, 1}}, mesh.triangles, x, 100 * thickness, w, expected);
      remove_tangled_pairs({1, 1, 1, 1, 1, 1, 0, 0, 0}, close);
      CHECK((close.size() < all || thickness < 0.5));
    }
    const long repelled = repel(close, x, filter.settings, 0.1, w, expected, 1);
    CHECK(repelled > 0);
    CHECK(work.close_pairs == repelled);
    CHECK(work.crossings == 0);
    CHECK(v == expected);
  }

  // once it is out, it is kept out
  filter.at_start = {{0, 1}};
  PerParticle3 apart = x, v = PerParticle3::Zero(3, 9);
  apart.leftCols(3).row(2).array() += 0.75;
  v.leftCols(3).row(2).setConstant(-9);
  Work work;
  filter.correct(step, at_rest(apart), v, work);
  CHECK(work.crossings + work.zones > 0);
}
