// One run on several threads: every bit is that of one thread.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "reference/mesh/shapes.h"
#include "verification/checks/dynamics/dynamics_checks.h"
#include "verification/evidence.h"
#include "verification/specimens/contact_scenes.h"
#include "verification/specimens/followed_runs.h"
#include "verification/specimens/layered_cloth.h"

namespace foldproof {

namespace {

/// All numbers of the run; none if it is not what it is meant to be.
Numbers numbers_on(int threads, const NamedRun& of) {
  System system = build_system(of.scene);
  set_team(system, threads);
  Followed run;
  run.result = simulate(system, integrator_named(of.integrator), start_state(of.scene),
                        of.scene.schedule, follower(run));
  if (run.result.stop.has_value() != of.stops || run.frames.empty()) return {};
  return numbers_after(run, 0, 0, 0);
}

/// A sheet of n x n alternating cells.
TriangleMesh plain_mesh(int n) { return make_sheet({SheetPattern::alternating, 1.3, 1.1, n, n}); }

/// The same, its particles numbered at random: each thread then shares most elements with others.
TriangleMesh shuffled_mesh(int n) {
  const TriangleMesh plain = plain_mesh(n);
  std::vector<int> number(size_t(plain.particles()));
  std::iota(number.begin(), number.end(), 0);
  std::shuffle(number.begin(), number.end(), std::mt19937(3));
  PerParticle3 rest(3, plain.particles());
  for (int i = 0; i < plain.particles(); ++i) rest.col(number[size_t(i)]) = plain.rest.col(i);
  std::vector<Triangle> triangles = plain.triangles;
  for (Triangle& triangle : triangles)
    for (int& corner : triangle) corner = number[size_t(corner)];
  return make_triangle_mesh(std::move(rest), std::move(triangles));
}

/// The sheet waved and moving, damped, with a particle held.
Scene waved(TriangleMesh mesh) {
  Scene scene = scene_at_rest(std::move(mesh), 0.21);
  const double height = 0.1 / std::sqrt(double(scene.x.cols()));  // m
  scene.stretch = StretchMaterial{31, 0.017, 1};
  scene.bending = BendingMaterial{0.0019, 0.00023, Weighting::rest, DampingFactor::edge, "sine"};
  scene.rest_angles.assign(scene.mesh.hinges.size(), 0.03);
  scene.gravity = Vector3(0.4, -9.1, 0.7);
  for (Eigen::Index i = 0; i < scene.x.cols(); ++i) {
    scene.x(2, i) += height * std::sin(37 * scene.x(0, i)) * std::cos(29 * scene.x(1, i));
    scene.v.col(i) = Vector3(std::cos(5 * scene.x(1, i)), std::sin(7 * scene.x(0, i)),
                             std::cos(3 * scene.x(0, i)));
  }
  scene.prescribed.push_back({0, scene.x.col(0), Motion{}});
  return scene;
}

/// So many steps of half the elastic limit, each a frame.
NamedRun stepped(const std::string& name, Scene scene, int steps) {
  const double h = 0.5 * elastic_limit(build_system(scene), start_state(scene));
  scene.schedule = {steps * h, h, {h, 0.5, 0.1}, 100000};
  return {name, "C", std::move(scene)};
}

/// A sheet of 100 x 100 particles on a large ball: contacts in several blocks of queries.
Scene on_a_ball(PointKind points) {
  Scene scene = waved(plain_mesh(99));
  Pose below;
  below.translation = Vector3(0.63, 0.52, -400);
  SceneObject ball = object_at("ball", Sphere{400}, below);
  ball.object.friction = 0.3;
  scene.objects.push_back(ball);
  scene.collision.points = points;
  return scene;
}

/// Sheets thrown through each other, were it not for many impulses in a step.
NamedRun thrown_layers() {
  LayeredSheets layers;
  layers.sheets = 6;
  layers.speed = 23;
  layers.settings = {0.004, 3.0, 0.3, 8, true};
  Scene scene = layered_scene(layers);
  scene.stretch = StretchMaterial{20, 0.01, 1};
  scene.schedule = {0.006, 0.001, {0.001, 0.5, 0.1}, 100000};
  return {"layers thrown at each other", "C", std::move(scene)};
}

/// Sums and searches of many parts.
std::vector<NamedRun> larger_runs() {
  return {stepped("316 x 316 particles", waved(plain_mesh(315)), 1),
          stepped("particles numbered at random", waved(shuffled_mesh(11)), 9),
          stepped("particles on a ball", on_a_ball(PointKind::particles), 3),
          stepped("edges on a ball", on_a_ball(PointKind::edges), 3), thrown_layers()};
}

/// Many triangles without area: the same stop, for the same particle.
NamedRun degenerate_run() {
  Scene scene = waved(shuffled_mesh(11));
  for (size_t t = 0; t < scene.mesh.triangles.size(); t += 5) {
    const auto [a, b, c] = scene.mesh.triangles[t];
    scene.x.col(a) = 0.5 * (scene.x.col(b) + scene.x.col(c));
  }
  scene.schedule = {0.02, 0.004, {0.001, 0.5, 0.1}, 100000};
  return {"triangles without area", "C", std::move(scene), true};
}

Finding threads_finding(const Subject&) {
  std::vector<NamedRun> runs = runs_of_all_parts();
  for (NamedRun& larger : larger_runs()) runs.push_back(std::move(larger));
  runs.push_back(degenerate_run());
  Table measured{{"case", ""}, {"threads", "1"}, {"numbers", "1"}, {"numbers that differ", "1"}};
  for (const NamedRun& run : runs) {
    const Numbers alone = numbers_on(1, run);
    for (const int threads : {2, 3, 7})
      measured.row(run.name + ", " + run.integrator, threads, alone.size(),
                   alone.empty() ? NAN : bits_that_differ(alone, numbers_on(threads, run)));
  }
  return judge_worst(measured, 0,
                     "each particle adds up the same numbers in the same order, and sums have "
                     "blocks of a fixed size, however many threads share the work");
}

}  // namespace

std::vector<Check> thread_checks() {
  return {{"dynamics.threads-change-no-bit",
           "A run on several threads has the bits of a run on one.", "good practice",
           threads_finding}};
}

}  // namespace foldproof
