// Runs that must have the same bits: resumed from a checkpoint, reusing computed values, on several
// threads.
#include <numeric>
#include <random>

#include "reference/fast/kept_values.h"
#include "reference/mesh/shapes.h"
#include "verification/specimens/check.h"
#include "verification/specimens/contact_scenes.h"
#include "verification/specimens/followed_runs.h"
#include "verification/specimens/layered_cloth.h"
#include "verification/specimens/moving_sheets.h"
#include "verification/specimens/sticking_scenes.h"

namespace foldproof {

namespace {

// ---- resumed

/// Most numbers that differ after an interruption, over all frames; NaN for an invalid run.
double differences(const NamedRun& of) {
  const Integrator& integrator = integrator_named(of.integrator);
  const Followed whole = followed_run(of, build_system(of.scene), integrator);
  if (whole.checkpoints.size() < 5 || whole.checkpoints.size() != whole.frames.size()) return NAN;
  if (whole.result.stop.has_value() != of.stops) return NAN;
  Worst worst;
  for (std::size_t k = 0; k < whole.checkpoints.size(); ++k) {
    const Followed rest =
        followed_rest(build_system(of.scene), integrator, whole.checkpoints[k], of.scene.schedule);
    worst.observe(bits_that_differ(numbers_after(whole, k + 1, whole.rows_at[k], k + 1),
                                   numbers_after(rest, 0, 0, 0)));
  }
  return worst.value();
}

Finding same_bits_finding() {
  Table measured{{"case", ""}, {"numbers that differ", "1"}};
  for (const NamedRun& run : runs_of_all_parts())
    measured.row(run.name + ", " + run.integrator, differences(run));
  return judge_worst(
      measured, 0,
      "a checkpoint holds everything a run remembers: frames, diagnostics, later checkpoints, work "
      "and stop have the same bits, whichever frame the run resumes from");
}

// ---- reused

/// All force values at a state.
Numbers numbers_at(const System& system, const State& s, Work work) {
  const Forces forces = forces_at(system.forces, s, work);
  PerParticle3 damping = PerParticle3::Zero(3, s.x.cols());
  forces.damping->add_product(s.v, damping);
  Numbers numbers = {elastic_limit(system, s, work)};
  for (const auto term : energy_terms) numbers.push_back(energies(system, s, work).*term);
  for (const PerParticle3& f : {*forces.elastic, damping})
    numbers.insert(numbers.end(), f.data(), f.data() + f.size());
  return numbers;
}

/// A state and variants, each with one change that may affect the forces.
std::vector<std::pair<std::string, State>> neighbours_of(const State& s) {
  State moved = s, later = s, freed = s, faster = s;
  moved.x(1, s.x.cols() - 1) = std::nextafter(moved.x(1, s.x.cols() - 1), 1e9);
  later.time += 0.003;
  freed.bonds.pop_back();
  faster.v *= 1.7;
  return {{"the same", s},
          {"a coordinate by a rounding", moved},
          {"the time", later},
          {"a bond less", freed},
          {"the velocity", faster}};
}

/// A force that depends on the velocity, as in an experiment.
CustomForce experiment() {
  CustomForce force;
  force.elastic = [](const State& s, PerParticle3& f) { f -= 0.3 * s.v; };
  force.potential = [](const State& s) { return 0.3 * s.v.squaredNorm(); };
  return force;
}

/// Forces at neighbouring states, one after the other, in a run that keeps values.
void see_neighbours(bool has_custom, Table& measured) {
  StuckSpecimen specimen = stuck_to_turning_surface();
  specimen.scene.stretch = StretchMaterial{3.7, 0.6, 1};
  System system = build_system(specimen.scene);
  if (has_custom) system.forces.push_back(experiment());
  const State& start = specimen.state;
  for (const auto& [what, next] : neighbours_of(start)) {
    Work work;
    work.kept = std::make_shared<KeptValues>();
    numbers_at(system, start, work);
    measured.row(what + (has_custom ? ", with a custom force" : ""), start.bonds.size(),
                 start.bonds.empty() ? NAN
                                     : bits_that_differ(numbers_at(system, next, work),
                                                        numbers_at(system, next, {})));
  }
}

thread_local const Integrator* forgetful_of = nullptr;

/// The step of `forgetful_of` in a run that keeps nothing.
State forgetful_step(const System& system, std::span<const State> past, double h, Work& work) {
  Work forgetting = work;
  forgetting.kept = nullptr;
  State next = forgetful_of->step(system, past, h, forgetting);
  forgetting.kept = work.kept;
  work = forgetting;
  return next;
}

Numbers numbers_of_run(const NamedRun& of, bool forgets) {
  Integrator integrator = integrator_named(of.integrator);
  forgetful_of = &integrator_named(of.integrator);
  if (forgets) integrator.step = forgetful_step;
  return numbers_of(of, followed_run(of, build_system(of.scene), integrator));
}

Finding reuse_finding() {
  Table measured("case; numbers or bonds [1]; numbers that differ [1]");
  see_neighbours(false, measured);
  see_neighbours(true, measured);
  for (const NamedRun& run : runs_of_all_parts()) {
    const Numbers kept = numbers_of_run(run, false);
    measured.row("run: " + run.name + ", " + run.integrator, kept.size(),
                 kept.empty() ? NAN : bits_that_differ(kept, numbers_of_run(run, true)));
  }
  return judge_worst(
      measured, 0, "a value is used again only for the same position, time and bonds, to the bit");
}

/// Steps by hand: the number of force evaluations, beyond one per step and one at the start.
Finding once_finding() {
  Table measured("scheme; of; asked [1]; computed [1]; too many [1]");
  constexpr int steps = 7;
  for (const NamedRun& run : runs_of_all_parts()) {
    const Integrator& integrator = integrator_named(run.integrator);
    if (run.name != "led" || integrator.family != Family::mixed) continue;
    const System system = build_system(run.scene);
    State s = start_state(run.scene);
    Work work;
    work.kept = std::make_shared<KeptValues>();
    for (int n = 0; n < steps; ++n) {
      const double h = 0.5 * elastic_limit(system, s, work);
      s = integrator.step(system, {&s, 1}, h, work);
      energies(system, s, work);
    }
    const ForceCounts computed = computed_in_run(system.forces, work);
    const auto see = [&](const std::string& of, long asked, long count) {
      measured.row(run.integrator, of, asked, count,
                   asked == 2 * steps ? double(count - steps - 1) : NAN);
    };
    see("shapes", work.elastic_evaluations, computed.shapes);
    see("elastic forces", work.elastic_evaluations, computed.elastic);
    see("damping", work.damping_preparations, computed.damping);
  }
  return judge_worst(
      measured, 0,
      "a step begins where the one before ended, and limit and energies need the same shapes");
}

// ---- threads

Numbers numbers_on(int threads, const NamedRun& of) {
  System system = build_system(of.scene);
  set_team(system, threads);
  return numbers_of(of, followed_run(of, system, integrator_named(of.integrator)));
}

/// A sheet of n x n alternating cells.
TriangleMesh plain_mesh(int n) { return make_sheet({SheetPattern::alternating, 1.3, 1.1, n, n}); }

/// The same, numbered at random: most elements then have particles of several threads.
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

/// The sheet waved and moving, damped, under gravity, with one particle held.
Scene held_and_waved(TriangleMesh mesh) {
  const double height = 0.1 / std::sqrt(double(mesh.particles()));  // m
  Scene scene = waved_sheet(std::move(mesh), height);
  scene.gravity = Vector3(0.4, -9.1, 0.7);
  scene.prescribed.push_back({0, scene.x.col(0), Motion{}});
  return scene;
}

/// `steps` steps of half the elastic limit, each of them a frame.
NamedRun stepped(const std::string& name, Scene scene, int steps) {
  const double h = 0.5 * elastic_limit(build_system(scene), start_state(scene));
  scene.schedule = {steps * h, h, {h, 0.5, 0.1}, 100000};
  return {name, "C", std::move(scene)};
}

/// A sheet of 100 x 100 particles on a large ball: contacts in several blocks of queries.
Scene on_a_ball(PointKind points) {
  Scene scene = held_and_waved(plain_mesh(99));
  Pose below;
  below.translation = Vector3(0.63, 0.52, -400);
  SceneObject ball = object_at("ball", Sphere{400}, below);
  ball.object.friction = 0.3;
  scene.objects.push_back(ball);
  scene.collision.points = points;
  return scene;
}

/// Sheets that would be thrown through each other without many impulses in a step.
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

/// Sums and searches that have many parts.
std::vector<NamedRun> larger_runs() {
  return {stepped("316 x 316 particles", held_and_waved(plain_mesh(315)), 1),
          stepped("particles numbered at random", held_and_waved(shuffled_mesh(11)), 9),
          stepped("particles on a ball", on_a_ball(PointKind::particles), 3),
          stepped("edges on a ball", on_a_ball(PointKind::edges), 3), thrown_layers()};
}

/// Many triangles without area: the same stop, for the same particle.
NamedRun degenerate_run() {
  Scene scene = held_and_waved(shuffled_mesh(11));
  for (size_t t = 0; t < scene.mesh.triangles.size(); t += 5) {
    const auto [a, b, c] = scene.mesh.triangles[t];
    scene.x.col(a) = 0.5 * (scene.x.col(b) + scene.x.col(c));
  }
  scene.schedule = {0.02, 0.004, {0.001, 0.5, 0.1}, 100000};
  return {"triangles without area", "C", std::move(scene), true};
}

Finding threads_finding() {
  std::vector<NamedRun> runs = runs_of_all_parts();
  for (NamedRun& larger : larger_runs()) runs.push_back(std::move(larger));
  runs.push_back(degenerate_run());
  Table measured("case; threads [1]; numbers [1]; numbers that differ [1]");
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

std::vector<Check> same_bits_checks() {
  return {
      {"dynamics.resumed-run-ends-with-the-same-bits",
       "A run of the reference that resumes from any of its checkpoints ends with the same bits.",
       "good practice", same_bits_finding},
      {"dynamics.reuse-changes-no-bit",
       "A run that keeps forces and shapes for its next step has the bits of one that computes "
       "them anew.",
       "good practice", reuse_finding},
      {"dynamics.each-position-is-evaluated-once",
       "Schemes A, B and C compute shapes, elastic forces and damping once for each position.",
       "good practice", once_finding},
      {"dynamics.threads-change-no-bit", "A run on several threads has the bits of a run on one.",
       "good practice", threads_finding}};
}

}  // namespace foldproof
