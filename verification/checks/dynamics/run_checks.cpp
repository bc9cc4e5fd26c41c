// Runs: frames at their times, steps within their limits, and stops that report the reason.
#include "reference/dynamics/simulate.h"
#include "reference/mesh/shapes.h"
#include "reference/scene/scene.h"
#include "verification/specimens/check.h"
#include "verification/specimens/differences.h"
#include "verification/specimens/followed_runs.h"
#include "verification/specimens/moving_sheets.h"
#include "verification/specimens/stepper.h"

namespace foldproof {

namespace {

Followed record_run(const System& system, const std::string& integrator, const State& start,
                    const Schedule& schedule) {
  return followed_run(system, integrator_named(integrator), start, schedule);
}

/// Largest error in time [s] of the frames of a run that should have `frames` frames; product and
/// sum may be rounded together. NaN for a wrong count or a step longer than requested.
double frame_error(const Followed& run, const Schedule& schedule, size_t frames) {
  Worst worst;
  if (run.frames.size() != frames || run.result.stop) worst.observe(NAN);
  const double start = run.frames.front().time, fixed = schedule.step.fixed;
  for (size_t k = 0; k < run.frames.size(); ++k) {
    // rounded, even if the compiler fuses
    const volatile double whole = double(k) * schedule.frame_interval;
    const double apart = std::min(schedule.end, start + whole),
                 as_one =
                     std::min(schedule.end, std::fma(double(k), schedule.frame_interval, start));
    const double time = run.frames[k].time;
    worst.observe(std::min(std::abs(time - apart), std::abs(time - as_one)));
  }
  for (const Diagnostics& row : run.rows)
    if (fixed > 0 && !(row.step <= fixed * (1 + 2e-9))) worst.observe(NAN);
  if (fixed == schedule.frame_interval && run.result.steps != long(frames) - 1) worst.observe(NAN);
  return worst.value();
}

Finding frames_finding() {
  const double interval = 0.0113, length = 0.0517;  // four whole intervals and a remainder
  Scene scene = partly_prescribed_sheet();
  scene.prescribed.clear();  // their paths begin at time 0, these runs do not
  Table errors("start [s]; step asked for, 0: automatic [s]; error of the times [s]");
  for (double start_time : {0.21, -0.0171, -0.0083, -0.0231})
    for (double fixed : {0.0017, 0.0113, 0.0}) {
      System system = build_system(scene);
      if (fixed == interval) system.forces.clear();  // so long a step suits free flight only
      State start = start_state(scene);
      start.time = start_time;
      const Schedule schedule{start_time + length, interval, {fixed, 0.5, 0.1}, 100000};
      errors.row(start_time, fixed,
                 frame_error(record_run(system, "A", start, schedule), schedule, 6));
    }
  return judge_worst(errors, 0,
                     "frame times are set, not summed up; a step longer than requested, or a wrong "
                     "count, gives NaN");
}

/// Largest relative change of an edge's length over its rest length in a step h, by its
/// present rate [1].
double strain_in(const Scene& scene, const State& s, double h) {
  Worst worst;
  for (const Edge& edge : scene.mesh.edges) {
    const double rest = scene.stretch->rest_length_scale *
                        (scene.mesh.rest.col(edge.b) - scene.mesh.rest.col(edge.a)).norm();
    const Vector3 d = s.x.col(edge.b) - s.x.col(edge.a), dv = s.v.col(edge.b) - s.v.col(edge.a);
    worst.observe(std::abs(d.normalized().dot(dv)) * h / rest);
  }
  return worst.value();
}

Finding limits_finding() {
  constexpr size_t least_steps = 4;  // too few to show that the step follows the cloth
  Worst worst;
  Table used("speed [1]; of the elastic limit [1]; of the strain allowed [1]; came to [1]");
  for (double speed : {0.01, 0.4, 9.0, 25.0})
    for (double strain : {0.013, 0.09}) {
      Scene scene = free_sheet();
      scene.v *= speed;
      scene.schedule = {0.031, 0.0173, {0, 0.37, strain}, 100000};
      const System system = build_system(scene);
      State s = start_state(scene);
      const Followed run = record_run(system, "C", s, scene.schedule);
      Worst of_limit, of_strain;
      for (size_t n = 1; n < run.rows.size(); ++n) {  // the run again, step by step
        const double h = run.rows[n].step;
        of_limit.observe(h / (0.37 * elastic_limit(system, s)));
        of_strain.observe(strain_in(scene, s, h) / strain);
        s = step_once("C", system, s, h);
        s.time = run.rows[n].time;
      }
      if (run.rows.size() <= least_steps || largest_difference(s.x, run.result.last.x) != 0)
        worst.observe(NAN);
      used.row(speed, of_limit.value(), of_strain.value(),
               run.result.stop ? run.result.stop->reason : "the end");
      worst.observe(of_limit.value());
      worst.observe(of_strain.value());
    }
  return {{worst.value(), 1 + 2e-9, 0, "of the limit",
           "both limits hold at the start of every step; a step may be stretched by 1e-9 to divide "
           "an interval evenly"},
          used,
          "The run is repeated step by step with the steps it reported, and must end with the same "
          "bits. A run in which a triangle loses its area, as can happen at 25 m/s, is judged up "
          "to there."};
}

/// The finding about a stopped run.
Finding judged_statements(const Table& statements, const std::string& note) {
  return {{count_false(statements), 0, 0, "false statements", "a statement is true or false"},
          statements,
          note};
}

bool all_finite(const std::vector<State>& frames) {
  for (const State& s : frames)
    if (!s.x.allFinite() || !s.v.allFinite()) return false;
  return true;
}

void add_common(Table& statements, const Followed& run) {
  statements.row("it stopped", run.result.stop.has_value());
  if (!run.result.stop) return;
  statements.row("the time is that of the last good state",
                 run.result.stop->time == run.result.last.time);
  statements.row("the step is the one after the last good one",
                 run.result.stop->step == run.result.steps + 1);
  statements.row("all frames delivered are finite", all_finite(run.frames));
  statements.row("the last good state is finite", all_finite({run.result.last}));
}

/// Where nearly all pairs of a cloth that flies apart would meet in a step, it is not taken.
void add_explosion(Table& statements) {
  const Scene scene = read_scene_text(R"(
    cloth = { shape = "sheet", width = 1, height = 1, columns = 24, rows = 24, density = 0.2 }
    gravity = {}
    stretch = { stiffness = 50 }
    bending = { stiffness = 1e-3 }
    self_collision = { thickness = 0.002, stiffness = 5 }
    hold = [{ particles = [0, 24] }]
    time = { end = 1, step = 0.002, integrator = "forward-euler" })",
                                      "explodes.toml");
  const Followed run =
      record_run(build_system(scene), "forward-euler", start_state(scene), scene.schedule);
  const double triangles = double(scene.mesh.triangles.size());
  statements.row("with self-collision it stops, too",
                 run.result.stop && run.result.stop->reason.find("divergence") == 0);
  statements.row(
      "each triangle was then tested against fewer than 10 others a step, as a mean",
      double(run.result.work.crossing_queries) < 10 * triangles * double(run.result.steps));
}

Finding divergence_finding() {
  const Scene scene = undamped_sheet();
  const System system = build_system(scene);
  const State start = start_state(scene);
  const double h = 3 * elastic_limit(system, start);
  const Followed run = record_run(system, "C", start, {400 * h, 2 * h, {h, 0.5, 0.1}, 100000});
  Table statements = no_statements();
  add_common(statements, run);
  if (run.result.stop) {
    const Stop& stop = *run.result.stop;
    const State& last = run.result.last;
    const State next = step_once("C", system, last, h);
    Eigen::Index farthest = 0;
    (next.x - last.x).colwise().norm().maxCoeff(&farthest);
    statements.row("the reason says divergence",
                   stop.reason.find("divergence") != std::string::npos);
    statements.row("the particle is the one that moved farthest", stop.particle == farthest);
    const double size = (start.x.rowwise().maxCoeff() - start.x.rowwise().minCoeff()).norm();
    Worst leap;
    for (size_t k = 1; k < run.frames.size(); ++k)
      leap.observe(largest_difference(run.frames[k].x, run.frames[k - 1].x) / size);
    statements.row("within a frame no particle moves more than 20 sizes in its two steps",
                   leap.value() <= 20);
    statements.row("earlier frames were delivered",
                   run.frames.size() >= 2 && long(run.frames.size()) == run.result.steps / 2 + 1);
  }
  add_explosion(statements);
  return judged_statements(statements, "fixed steps of three times the elastic limit");
}

Finding nan_finding() {
  Scene scene = partly_prescribed_sheet();
  scene.stretch.reset();
  scene.bending.reset();
  System system = build_system(scene);
  CustomForce force;
  force.elastic = [](const State& s, PerParticle3& f) {
    if (s.time > 0.0221) f(1, 5) = NAN;
  };
  system.forces.push_back(force);
  const Followed run =
      record_run(system, "C", start_state(scene), {0.1, 0.01, {0.0034, 0.5, 0.1}, 100000});
  Table statements = no_statements();
  add_common(statements, run);
  if (run.result.stop) {
    statements.row("the reason says NaN", run.result.stop->reason.find("NaN") != std::string::npos);
    statements.row("the particle is 5", run.result.stop->particle == 5);
    statements.row("the step is 7", run.result.stop->step == 7);
    statements.row("three frames were delivered", run.frames.size() == 3);
  }
  return judged_statements(statements, "a force becomes NaN after 0.0221 s, in the seventh step");
}

Finding lost_triangle_finding() {
  const double length = 0.43, duration = 0.05;
  Scene scene = scene_at_rest(make_hinge(length, 0.31), 0.21);
  scene.bending = BendingMaterial{3.7e-4, 1.9e-6, Weighting::rest, DampingFactor::edge, "sine"};
  scene.rest_angles = {0.31};
  Motion squeeze;  // moves the first vertex into the shared edge
  squeeze.velocity = Vector3(0, -0.9 * length / duration, 0);
  scene.prescribed = {
      {0, scene.x.col(0), squeeze}, {2, scene.x.col(2), Motion{}}, {3, scene.x.col(3), Motion{}}};
  const Followed run = record_run(build_system(scene), "C", start_state(scene),
                                  {0.2, 0.01, {0.0025, 0.5, 0.1}, 100000});
  Table statements = no_statements();
  add_common(statements, run);
  if (run.result.stop) {
    const std::string& reason = run.result.stop->reason;
    statements.row("the reason says what was lost", reason.find("triangle") != std::string::npos &&
                                                        reason.find("area") != std::string::npos);
    statements.row("the reason names the four particles",
                   reason.find("particles 0 1 2 3") != std::string::npos);
    statements.row("a particle is named", run.result.stop->particle == 0);
    statements.row("the step is 20", run.result.stop->step == 20);
    statements.row("five frames were delivered", run.frames.size() == 5);
  }
  return judged_statements(
      statements,
      "a vertex is moved into the opposite edge, which it reaches at the end of step 20");
}

Finding cap_finding() {
  const Scene scene = free_sheet();
  const Followed run =
      record_run(build_system(scene), "B", start_state(scene), {0.1, 0.01, {0.002, 0.5, 0.1}, 13});
  Table statements = no_statements();
  add_common(statements, run);
  statements.row("13 steps were made", run.result.steps == 13);
  if (run.result.stop) {
    statements.row("the reason says cap", run.result.stop->reason.find("cap") != std::string::npos);
    statements.row("no particle is blamed", run.result.stop->particle == -1);
  }
  return judged_statements(statements, "a cap of 13 steps");
}

Finding standstill_finding() {
  const Scene scene = free_sheet();
  State start = start_state(scene);
  start.time = 1;
  const Followed run =
      record_run(build_system(scene), "B", start, {1.1, 0.01, {1e-17, 0.5, 0.1}, 20});
  Table statements = no_statements();
  add_common(statements, run);
  statements.row("no step was made", run.result.steps == 0);
  if (run.result.stop)
    statements.row("the reason says too short",
                   run.result.stop->reason.find("too short") != std::string::npos);
  return judged_statements(
      statements, "fixed steps of 1e-17 s from t = 1 s on, where doubles lie 2e-16 s apart");
}

}  // namespace

std::vector<Check> run_checks() {
  const std::string ours = "our reading of BMF03 section 3", stops = "good practice";
  return {
      {"dynamics.frames-are-hit-exactly",
       "Runs of the reference deliver frames at exactly their times, with steps no longer than "
       "requested.",
       ours, frames_finding},
      {"dynamics.automatic-steps-respect-the-limits",
       "Automatic steps of the reference obey the safety factor of the elastic limit and the "
       "strain allowed in a step.",
       ours, limits_finding},
      {"dynamics.divergence-stops-the-run",
       "A diverging run of the reference stops and names time, step and particle.", stops,
       divergence_finding},
      {"dynamics.nan-stops-the-run",
       "A run of the reference that meets NaN stops and names time, step and particle.", stops,
       nan_finding},
      {"dynamics.degenerate-triangle-stops-the-run",
       "A run of the reference that loses a triangle stops and names its particles.", stops,
       lost_triangle_finding},
      {"dynamics.too-short-steps-stop-the-run",
       "A run whose steps no longer advance the time stops and says so.", stops,
       standstill_finding},
      {"dynamics.step-cap-stops-the-run",
       "A run of the reference that reaches its cap on steps stops and says so.", stops,
       cap_finding},
  };
}

}  // namespace foldproof
