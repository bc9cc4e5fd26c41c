// Rest: what a search gives up, and where a run that waits for rest ends.
#include <catch2/catch.hpp>

#include "reference/dynamics/settle.h"
#include "reference/bodies/level_set_provider.h"
#include "reference/mesh/shapes.h"
#include "reference/scene/scene.h"
#include "verification/cases/cantilever.h"
#include "verification/specimens/contact_scenes.h"
#include "verification/specimens/specimens.h"

using namespace foldproof;

namespace {

/// A strip, held by its first two columns, that starts level.
Scene strip(double length) {
  Scene scene = scene_at_rest(make_sheet({SheetPattern::alternating, length, 0.02, 12, 3}), 0.21);
  scene.stretch = StretchMaterial{300, 0, 1};
  add_flat_hinges(scene, 6e-5, 0);
  scene.gravity = Vector3(0, 0, -9.80665);
  for (Eigen::Index i = 0; i < scene.x.cols(); ++i)
    if (scene.x(0, i) < 1.5 * length / 12) scene.prescribed.push_back({int(i), scene.x.col(i), {}});
  return scene;
}

RestSearch search_of(const Scene& scene, const BuiltScene& of) {
  return {1e-8, 2 * smallest_height(scene.mesh.triangles, scene.mesh.rest),
          0.5 * elastic_limit(of.system, of.start), 600};
}

/// Long steps of backward Euler damp it.
RunResult run_until_rest(const BuiltScene& of, const State& start, double end) {
  Schedule schedule{end, 0.05, {.fixed = 0.05}};
  schedule.rest = RestLimits{1e-3, 1e-2};
  return simulate(of.system, integrator_named("linear-backward-euler"), start, schedule, {});
}

}  // namespace

TEST_CASE("a run until rest ends where speeds and forces are small, not where one of them is") {
  const Scene scene = strip(0.06);
  const BuiltScene of = build(scene, computing_provider());
  const RunResult level = run_until_rest(of, of.start, 20);  // no speed, but its weight
  REQUIRE(level.rest);
  CHECK(level.rest->reached);
  CHECK(level.last.time > 0.02);
  CHECK(level.last.time < 20);
  CHECK(level.last.v.colwise().norm().maxCoeff() < 1e-3);

  const Rest rest = settle(of.system, of.start, search_of(scene, of));
  CHECK((level.last.x - rest.state.x).cwiseAbs().maxCoeff() < 1e-3);
  CHECK(run_until_rest(of, rest.state, 6).last.time == rest.state.time);
  State passing = rest.state;  // balanced, but on its way
  for (const int i : free_particles(scene)) passing.v.col(i) = Vector3(0.1, 0, 0);
  CHECK(run_until_rest(of, passing, 6).last.time > 0.02);

  const RunResult early = run_until_rest(of, of.start, 0.1);
  REQUIRE(early.rest);
  CHECK_FALSE(early.rest->reached);
  CHECK_FALSE(early.stop);
  CHECK(early.last.time == 0.1);
}

TEST_CASE("nothing rests while a motion is to come") {
  Scene scene = strip(0.06);
  BuiltScene of = build(scene, computing_provider());
  const State rest = settle(of.system, of.start, search_of(scene, of)).state;
  Motion later;
  later.velocity = Vector3(0, 0, 0.01);
  later.from = 0.03;
  later.until = 0.05;
  scene.prescribed[0].motion = later;
  of = build(scene, computing_provider());
  CHECK_THROWS_WITH(settle(of.system, of.start, search_of(scene, of)),
                    Catch::Contains("prescribed particle"));
  CHECK(run_until_rest(of, rest, 0.3).last.time > 0.05);
}

TEST_CASE("a cloth that nothing holds does not rest, and the search says so") {
  const Scene scene = [] {
    Scene falling = strip(0.06);
    falling.prescribed.clear();
    return falling;
  }();
  const BuiltScene of = build(scene, computing_provider());
  RestSearch search = search_of(scene, of);
  search.most_steps = 20;
  const Rest rest = settle(of.system, of.start, search);
  CHECK(rest.unbalanced.over_weight == Approx(1).epsilon(1e-3));
  CHECK(rest.steps == 20);
}

TEST_CASE("a clamped strip at rest is as low as its elastica") {
  const Scene scene = strip(0.1);
  const BuiltScene of = build(scene, computing_provider());
  const Rest rest = settle(of.system, of.start, search_of(scene, of));
  const auto clamped = clamped_strip(scene, rest.state.x);
  REQUIRE(clamped);
  CHECK(clamped->length == Approx(0.1 * 11.5 / 12));
  CHECK(clamped->drop == Approx(clamped->elastica_drop).epsilon(0.02));
  CHECK(clamped->reach == Approx(clamped->elastica_reach).epsilon(0.04));

  Scene other = scene;
  other.prescribed.pop_back();
  CHECK_FALSE(clamped_strip(other, rest.state.x));
  other = scene;
  other.objects.push_back(object_at("ball", Sphere{0.1}, Pose{}));
  CHECK_FALSE(clamped_strip(other, rest.state.x));
}
