// The self-collision filter: the pairs that it keeps, its rounds of impulses, its zones,
// and tangled cloth.
#include <catch2/catch.hpp>
#include <random>

#include "reference/fast/kept_values.h"
#include "reference/mesh/shapes.h"
#include "reference/filters/approach.h"
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

/// Three jittered sheets of 3 x 3 cells, one above the other.
TriangleMesh three_sheets() {
  std::mt19937 random(17);
  std::uniform_real_distribution<double> jitter(-0.02, 0.02);
  PerParticle3 x(3, 48);
  std::vector<Triangle> triangles;
  for (int sheet = 0; sheet < 3; ++sheet)
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 4; ++i) {
        const int p = 16 * sheet + 4 * j + i;
        x.col(p) << 0.1 * i + jitter(random), 0.1 * j + jitter(random),
            0.06 * sheet + 0.5 * jitter(random);
        if (i == 3 || j == 3) continue;
        triangles.push_back({p, p + 1, p + 5});
        triangles.push_back({p, p + 5, p + 4});
      }
  return make_triangle_mesh(x, triangles);
}

/// The rounds of impulses, pair by pair.
struct Rounds {
  PerParticle3 v;
  long queries = 0, crossings = 0;
  int last = 0;  // the round that found nothing
};
Rounds resolved(const SelfCollision& filter, const PerParticle3& x, const PerParticle3& start,
                double h) {
  const double thickness = filter.settings.thickness, least = 0.1 * thickness;
  Rounds now{start};
  std::vector<char> moved;
  for (; now.last < filter.settings.rounds; ++now.last) {
    const auto pairs = near_pairs(filter.cloth, x, x + h * now.v, 2 * least, moved);
    moved.assign(size_t(x.cols()), 0);
    now.queries += long(pairs.size());
    long found = 0;
    for (const FeaturePair& pair : pairs) {
      const auto met =
          first_approach(pair.kind, corners_of(pair, x), h * corners_of(pair, now.v), least);
      if (!met) continue;
      ++found;
      for (const int i : pair.particles) moved[size_t(i)] = 1;
      const Vector3 N = met->at.normal;
      const double gap = N.dot(corners_of(pair, x) * met->at.weights);
      const Vector3 relative = corners_of(pair, now.v) * met->at.weights;
      const double allowed = now.last == 0 && gap > thickness ? -(gap - thickness) / h : 0;
      const double push = allowed - relative.dot(N);
      if (push <= 0) continue;
      const Vector3 friction = friction_impulse(relative, N, push, filter.settings.friction);
      push_apart(pair, met->at.weights, push * N + friction, filter.inverse_mass, now.v);
    }
    now.crossings += found;
    if (found == 0) break;
  }
  return now;
}

}  // namespace

TEST_CASE("pairs are kept with 0.12 edges to spare, and looked for when half of them is used up") {
  const TriangleMesh mesh = three_sheets();
  const SelfCollision filter =
      filter_of(mesh, {0.01, 3, 0.2, 8, true}, PerParticle::Constant(48, 0.7));
  CHECK(filter.at_start.empty());
  State s = at_rest(mesh.rest);
  filter.look_ahead(s, {});  // of no run that keeps anything
  Work work;
  work.kept = std::make_shared<KeptValues>();
  const PairsAhead& kept = work.kept->of<PairsAhead>(filter);
  CHECK(kept.boxes.empty());
  const auto middle = [&] { return kept.boxes.at(31).center(); };
  filter.look_ahead(s, work);
  const double spare = 0.12 * rest_lengths(mesh).mean();
  CHECK((kept.boxes.at(5).max() - s.x.col(5) - Vector3::Constant((0.01 + spare) / 2)).norm() <
        1e-15);
  const Vector3 first = middle();
  s.x(1, 31) += 0.99 * spare / 4;
  filter.look_ahead(s, work);
  CHECK(middle() == first);
  s.x(1, 31) += 0.02 * spare / 4;
  filter.look_ahead(s, work);
  CHECK((middle() - s.x.col(31)).norm() < 1e-15);
}

TEST_CASE("a velocity that ends a step is kept from approaching within the thickness only") {
  const TriangleMesh mesh = dart_over_triangle();
  Work work;
  work.close_pairs = 30;
  PerParticle3 v = falling_dart();
  SelfCollision filter = filter_of(mesh, {0.06, 0, 0, 8, true}, with_prescribed_floor());
  filter.correct(ends, at_rest(mesh.rest), v, work);
  CHECK((v.col(3) - Vector3(0.3, 0.4, 0)).norm() < 1e-14);
  CHECK(v.col(4) == Vector3(0.3, 0.4, -1));
  CHECK(work.close_pairs == 31);
  filter.settings.thickness = 0.04;
  v = falling_dart();
  filter.correct(ends, at_rest(mesh.rest), v, work);
  CHECK(v == falling_dart());
  CHECK(work.close_pairs == 31);
  CHECK(work.crossing_queries == 0);
}

TEST_CASE("the first impulse lets a vertex come as near as the thickness, with friction") {
  const TriangleMesh mesh = dart_over_triangle();
  for (const int rounds : {1, 2, 8}) {
    const SelfCollision filter =
        filter_of(mesh, {0.01, 3, 0.2, rounds, true}, with_prescribed_floor());
    PerParticle3 v = falling_dart();
    Work work;
    work.crossings = 5, work.crossing_queries = 70;
    filter.correct(step, at_rest(mesh.rest), v, work);
    // 0.04 in 0.1 s; a push of 0.6, and 0.12 of the speed of 0.5 along
    CHECK((v.col(3) - Vector3(0.3 * 0.76, 0.4 * 0.76, -0.4)).norm() < 1e-13);
    CHECK(v.leftCols(3) == PerParticle3::Zero(3, 3));
    CHECK(v.rightCols(2) == falling_dart().rightCols(2));
    CHECK(work.crossings == 6);
    CHECK(work.zones == 0);
    CHECK(work.zone_particles == 0);
    const auto x = mesh.rest;
    const PerParticle3 start = falling_dart();
    const size_t first = near_pairs(filter.cloth, x, x + 0.1 * start, 0.002).size(),
                 second =
                     near_pairs(filter.cloth, x, x + 0.1 * v, 0.002, {1, 1, 1, 1, 0, 0}).size();
    CHECK(work.crossing_queries == 70 + long(first + second));
  }
}

TEST_CASE(
    "three sheets are kept apart pair by pair, the same with kept pairs and on several threads") {
  const TriangleMesh mesh = three_sheets();
  std::mt19937 random(5);
  std::uniform_real_distribution<double> speed(-0.7, 0.7);
  PerParticle3 start = PerParticle3::NullaryExpr(3, 48, [&] { return speed(random); });
  start.rightCols(16).row(2).array() -= 2.3;
  PerParticle w(48);
  for (int i = 0; i < 48; ++i) w[i] = i % 7 == 3 ? 0 : 0.3 + 0.05 * i;
  SelfCollision filter = filter_of(mesh, {0.009, 3, 0.2, 8, true}, w);
  const State s = at_rest(mesh.rest);
  const Rounds expected = resolved(filter, s.x, start, 0.1);
  CAPTURE(expected.last, expected.crossings);
  REQUIRE(expected.last > 1);
  REQUIRE(expected.crossings > 5);
  for (const auto& kept : {std::shared_ptr<KeptValues>(), std::make_shared<KeptValues>()})
    for (const int threads : {1, 3}) {
      filter.set_team(threads, 48);
      PerParticle3 v = start;
      Work work;
      work.kept = kept;
      filter.look_ahead(s, work);
      filter.correct(step, s, v, work);
      CHECK(work.close_pairs == 0);
      if (expected.last < 8) {
        CHECK(v == expected.v);
        CHECK(work.crossing_queries == expected.queries);
      }
      CHECK(work.crossings == expected.crossings);
      // and no pair meets after all
      const auto pairs = near_pairs(filter.cloth, s.x, s.x + 0.1 * v, 0.0018);
      const auto meets = [&](const FeaturePair& pair) {
        return first_approach(pair.kind, corners_of(pair, s.x), 0.1 * corners_of(pair, v), 0.0009)
            .has_value();
      };
      if (expected.last < 8) CHECK(std::none_of(pairs.begin(), pairs.end(), meets));
    }
}

TEST_CASE("without rounds what meets moves as a zone, and zones are counted with their particles") {
  const TriangleMesh mesh = dart_over_triangle();
  PerParticle w = with_prescribed_floor();
  for (const bool is_prescribed : {true, false}) {
    if (!is_prescribed) w.head(3) << 0.2, 0.4, 0.6;
    const SelfCollision filter = filter_of(mesh, {0.01, 3, 0.2, 0, true}, w);
    PerParticle3 v = falling_dart();
    v(2, 1) = v(2, 0) = v(2, 2) = -0.125;
    PerParticle3 expected = v;
    Work work;
    work.zones = 10, work.zone_particles = 20;
    filter.correct(step, at_rest(mesh.rest), v, work);
    move_as_one({0, 1, 2, 3}, mesh.rest, filter.mass, w, expected);
    CHECK((v - expected).norm() < 1e-13);
    CHECK(work.zones == 11);
    CHECK(work.zone_particles == 24);
    CHECK(work.crossings == 0);
    // every pair is asked once, and then those with a particle of the zone, but the zone's own
    const auto& x = mesh.rest;
    PerParticle3 start = falling_dart();
    start(2, 1) = start(2, 0) = start(2, 2) = -0.125;
    long queries = long(near_pairs(filter.cloth, x, x + 0.1 * start, 0.002).size());
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
  CHECK_NOTHROW(filter.correct(step, at_rest(mesh.rest), v, work));
  CHECK((v.col(3) - turning(3)).norm() < 1e-12);
  CHECK(work.zones == 1);

  PerParticle w = with_prescribed_floor();
  w[3] = 0;
  for (const int rounds : {0, 3}) {
    const SelfCollision driven = filter_of(mesh, {0.01, 3, 0.2, rounds, true}, w);
    PerParticle3 through = falling_dart();
    try {
      driven.correct(step, at_rest(mesh.rest), through, work);
      FAIL("not refused");
    } catch (const DegenerateElement& e) {
      CHECK(std::string(e.what()) ==
            "prescribed motion takes the cloth through itself (particles 3 0 1 2)");
      CHECK(e.particles == std::vector<int>{3, 0, 1, 2});
    }
    // one that stops in time is not
    PerParticle3 stops = falling_dart();
    stops.col(3) = Vector3(0.3, 0.4, -0.3);
    CHECK_NOTHROW(driven.correct(step, at_rest(mesh.rest), stops, work));
  }
}

TEST_CASE("tangled cloth is pushed out a thickness in a hundredth of a second, and let pass") {
  // triangles 0 and 1 cross; the third lies close above a corner of the second
  PerParticle3 x(3, 9);
  x << 0.3, 0.4, -3.1, 0, 3.2, 0.1, 2.9, 2.8, 3.1, 0.7, 0.6, 0.8, 0, 0.3, 2.9, 0.3, 1.9, 1.8, 0.9,
      -0.5, 0.35, 0.1, 0.2, 0.15, 0.2, 0.9, 1;
  x.col(6) = 0.1 * x.col(3) + 0.8 * x.col(4) + 0.1 * x.col(5) + Vector3(0, 0, 0.02);
  const TriangleMesh mesh = make_triangle_mesh(x, {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}});
  PerParticle w(9);
  w << 0.7, 0.3, 0.9, 0.2, 0.6, 0.4, 0.8, 0.5, 1.1;
  SelfCollision filter = filter_of(mesh, {0.03, 0, 0, 8, true}, w);
  PerParticle3 start = PerParticle3::Zero(3, 9);
  start(2, 6) = -0.4;
  for (const Span& span : {ends, step}) {
    filter.at_start = {{0, 1}};
    PerParticle3 v = start, expected = start;
    Work work;
    filter.correct(span, at_rest(x), v, work);
    push_out_of_tangle({{0, 1}}, mesh.triangles, x, 3, w, expected);
    std::vector<FeaturePair> close = near_pairs(filter.cloth, x, x, 0.03);
    remove_tangled_pairs({1, 1, 1, 1, 1, 1, 0, 0, 0}, close);
    const long repelled = repel(close, x, filter.settings, 0.1, w, expected, 1);
    CHECK(repelled > 0);
    CHECK(work.close_pairs == repelled);
    CHECK(work.crossings == 0);
    CHECK(v == expected);
    // of cloth that did not start so, nothing is asked
    filter.at_start = {};
    v = expected = start;
    filter.correct(ends, at_rest(x), v, work);
    repel(near_pairs(filter.cloth, x, x, 0.03), x, filter.settings, 0.1, w, expected, 1);
    CHECK(v == expected);
  }
  // nor are its close pairs repelled: there are some within 0.5
  filter.settings.thickness = 0.5;
  filter.at_start = {{0, 1}};
  PerParticle3 pushed = start, wanted = start;
  Work some;
  filter.correct(ends, at_rest(x), pushed, some);
  push_out_of_tangle({{0, 1}}, mesh.triangles, x, 50, w, wanted);
  std::vector<FeaturePair> within = near_pairs(filter.cloth, x, x, 0.5);
  PerParticle3 all_repelled = wanted;
  repel(within, x, filter.settings, 0.1, w, all_repelled, 1);
  remove_tangled_pairs({1, 1, 1, 1, 1, 1, 0, 0, 0}, within);
  repel(within, x, filter.settings, 0.1, w, wanted, 1);
  CHECK(pushed == wanted);
  CHECK(pushed != all_repelled);
  filter.settings.thickness = 0.03;

  // once it is out, it is kept out
  PerParticle3 apart = x;
  apart.leftCols(3).row(2).array() += 0.75;
  PerParticle3 v = PerParticle3::Zero(3, 9);
  v.leftCols(3).row(2).setConstant(-9);
  Work work;
  filter.correct(step, at_rest(apart), v, work);
  CHECK(work.crossings + work.zones > 0);
}

TEST_CASE("self-collision counts the pairs that it asks and those that it keeps apart") {
  // the corner of a triangle comes down on the inside of another
  PerParticle3 rest(3, 6);
  rest << 0, -0.08, 0.09, -0.11, 0.12, 0.01, -0.03, 0.02, -0.05, -0.1, -0.12, 0.1, 0.0024, 0.2,
      0.21, 0, 0, 0;
  Scene scene = scene_at_rest(make_triangle_mesh(std::move(rest), {{0, 1, 2}, {3, 4, 5}}), 0.17);
  scene.self_collision = SelfCollisionSettings{0.002, 0, 0, 8, true};
  const System system = build_system(scene);
  const auto& filter = std::get<SelfCollision>(system.filters.back());
  State s = start_state(scene);
  for (const auto& [speed, met] : {std::pair{0.1, 0}, std::pair{0.9, 1}}) {
    s.v.leftCols(3).row(2).setConstant(-speed);
    PerParticle3 v = s.v;
    Work work;
    filter.correct({0, 0.004, 0.004}, s, v, work);
    CHECK(work.crossings == met);
    CHECK(work.crossing_queries >= met);
    CHECK(work.zones == 0);
    CHECK((v != s.v) == (met > 0));
  }
}
