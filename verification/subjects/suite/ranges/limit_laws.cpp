// Limits that no scene states: of speed, of strain, of the length of a step; losses that each step
// makes; a gravity of the solver's own.

#include "verification/subjects/suite/laws.h"

namespace foldproof {

namespace {

using namespace suite;

// The springs of a soft sheet hardly act in the time of these laws, (omega t)^2 < 0.01: whatever
// the elastic law, each particle goes on as it started.
constexpr double free_enough = 0.02;  // of the path [1]; steps and rounding add less
constexpr long steps = 10;

constexpr const char* reason =
    "springs change the path by less than a hundredth, (omega t)^2, whatever the elastic law; as "
    "much for rounding";

Vector3 drawn_direction(std::string_view what) {
  const double turn = drawn(fmt::format("{} heading", what), 0, 2 * pi),
               height = drawn(fmt::format("{} height", what), -0.6, 0.6);
  return Vector3(std::cos(turn), std::sin(turn), height).normalized();
}

/// How far particles are from x + v t, over the largest path beside that of their mean [1].
double off_the_path(Trial& trial, const PortableScene& scene, bool is_relative) {
  require_softness(scene, steps);
  const PerParticle3 path = double(steps) * scene.dt * scene.v;
  const Vector3 mean = is_relative ? Vector3(path.rowwise().mean()) : Vector3::Zero();
  const PerParticle3 moved = trial.after(scene, steps).x - scene.x;
  return largest(moved - path) / largest(path.colwise() - mean);
}

Finding no_speed_is_too_fast(Trial& trial) {
  Table measured = table_of("speed [m/s] | error of the path [of the path]");
  for (const auto& [least, most] : {std::pair(3.0, 6.0), {11, 16}, {31, 60}, {110, 200}}) {
    PortableScene scene = soft_sheet("fast sheet");
    const double speed = drawn(fmt::format("speed from {}", least), least, most);
    scene.v.colwise() = speed * drawn_direction("fast sheet");
    measured.row(speed, off_the_path(trial, scene, false));
  }
  return judge_worst(measured, free_enough, reason);
}

/// A velocity that is linear in the position, such that strains grow at that rate [1/s]: enlarging,
/// shearing in the plane, turning out of it.
PortableScene deforming_sheet(int way, double rate) {
  PortableScene scene = soft_sheet("deforming sheet");
  const Vector3 middle = middle_of(scene.x);
  const Eigen::Matrix3d ways[] = {
      Vector3(1, 0.8, 0).asDiagonal(), Eigen::Matrix3d{{0, 1, 0}, {0.7, 0, 0}, {0, 0, 0}},
      Eigen::Matrix3d{{0, 0, 0}, {0, 0, 0}, {0.9, 1, 0}}, Vector3(-1, -0.6, 0).asDiagonal()};
  scene.v = rate * ways[way] * (scene.x.colwise() - middle);
  return scene;
}

constexpr const char* ways[] = {"enlarged", "sheared", "turned out of its plane", "compressed"};

Finding no_edge_is_too_fast(Trial& trial) {
  Table measured = table_of("sheet | speed of an edge's ends [m/s] | error [of the path]");
  for (const auto& [least, most] : {std::pair(0.6, 1.2), {5.0, 8.0}, {20, 40}})
    for (int way = 0; way < 4; ++way) {
      const double speed = drawn(fmt::format("edges from {}", least), least, most);
      PortableScene scene = deforming_sheet(way, speed / 0.1);
      scene.dt = 0.05 / (speed / 0.1) / double(steps);  // until strains of 5 %
      measured.row(ways[way], speed, off_the_path(trial, scene, true));
    }
  return judge_worst(measured, free_enough, reason);
}

Finding no_strain_is_too_large(Trial& trial) {
  Table measured = table_of("sheet | strain [1] | error [of the path]");
  for (const double strain : {0.12, drawn("strain", 0.31, 0.4), 0.6})
    for (int way = 0; way < 4; ++way) {
      constexpr double rate = 12;  // 1/s
      PortableScene scene = deforming_sheet(way, rate);
      scene.dt = strain / rate / double(steps);
      measured.row(ways[way], strain, off_the_path(trial, scene, true));
    }
  return judge_worst(measured, free_enough, reason);
}

/// Velocities after the steps along those of the start, a mean by momentum [1].
double kept_velocity(Trial& trial, PortableScene scene, double time, long count) {
  scene.dt = time / double(count);
  require_softness(scene, count);
  const PerParticle3 v = trial.after(scene, count).v;
  return (v.cwiseProduct(scene.v) * scene.mass).sum() /
         (scene.v.cwiseProduct(scene.v) * scene.mass).sum();
}

Finding no_step_takes_velocity(Trial& trial) {
  constexpr double time = 0.0064;  // s
  PortableScene drifts = soft_sheet("drifting soft sheet"), deforms = deforming_sheet(1, 5);
  drifts.v.colwise() = 1.7 * drawn_direction("drift");
  Table measured = table_of(
      "motion | velocity after 4 steps [of the start] | after 64 steps of the same time [of the "
      "start] | difference [1]");
  for (const auto& [name, scene] : {std::pair("drift", &drifts), {"shear", &deforms}}) {
    const double few = kept_velocity(trial, *scene, time, 4),
                 many = kept_velocity(trial, *scene, time, 64);
    measured.row(name, few, many, std::max(std::abs(few - 1), std::abs(many - 1)));
  }
  return judge_worst(measured, 0.004,
                     "no force of note acts: springs take less than 1e-3, (omega t)^2; the rest is "
                     "for rounding of single precision");
}

/// In its rest shape, so that springs do nothing, however long it takes. What gravity gives it is
/// judged by what it gave in the first second, since the size of gravity is another law's.
Finding velocity_is_kept_for_thousands_of_steps(Trial& trial) {
  Table measured = table_of("motion | time [s] | difference of the mean velocity [of what is due]");
  for (const bool falls : {false, true}) {
    PortableScene scene = sheet_of_cells(2);
    scene.name = falls ? "sheet that falls for seconds" : "sheet that drifts for seconds";
    scene.material.young = 1e-4;
    scene.v.colwise() = Vector3(0.9, -1.3, 0.4);
    if (falls) scene.gravity = Vector3(0.3, 0.2, -1.1);
    constexpr long first = 500, last = 2600;
    const std::vector<Snapshot> states = trial.motion(scene, {first, last});
    const auto mean = [&](int k) { return Vector3(states[k].v * scene.mass / scene.mass.sum()); };
    const Vector3 start = scene.v.col(0),
                  due = falls ? Vector3(start + double(last) / first * (mean(0) - start)) : start;
    measured.row(falls ? "fall" : "drift", double(last) * scene.dt,
                 (mean(1) - due).norm() / due.norm());
  }
  return judge_worst(measured, 0.004, "no other force acts; rounding of single precision is less");
}

Finding gravity_is_that_of_the_scene(Trial& trial) {
  Table measured = table_of("gravity [m/s^2] | error of the mean velocity [g t]");
  for (const double size : {0.4, 1.62, drawn("gravity", 14, 20), 24.8}) {
    PortableScene scene = soft_sheet("sheet in another gravity");
    scene.gravity = size * drawn_direction(fmt::format("gravity {}", size));
    const Vector3 gained = scene.gravity * double(4 * steps) * scene.dt,
                  mean = trial.after(scene, 4 * steps).v * scene.mass / scene.mass.sum();
    measured.row(size, (mean - gained).norm() / gained.norm());
  }
  return judge_worst(measured, 0.005, "rounding of single precision is less");
}

struct Thrown {
  double wrong_time;  // of the way or the speed: against x + v t across gravity, v + g t along it
  double deformed;    // of its size [1]
};

Thrown thrown_sideways(Trial& trial, PortableScene scene, double dt, long count) {
  scene.name = "sheet thrown sideways";
  scene.dt = dt;
  scene.v.colwise() = Vector3(2.7, -1.3, 0);
  scene.gravity = Vector3(0, 0, -9.81);
  const double time = double(count) * dt;
  const Snapshot end = trial.after(scene, count);
  const Vector3 moved = (end.x - scene.x).rowwise().mean(), path = time * scene.v.col(0);
  const double deformed = largest((end.x - scene.x).colwise() - moved) / largest(scene.x);
  const double speed = (end.v.row(2) * scene.mass)[0] / scene.mass.sum(), gained = -9.81 * time;
  return {std::max((moved - path).head<2>().norm() / path.norm(),
                   std::abs(speed - gained) / (std::abs(gained) + path.norm() / time)),
          deformed};
}

/// Steps may be too long for a stiff sheet: a solver without substeps may lose it.
Finding steps_last_as_long_as_asked(Trial& trial) {
  Table measured =
      table_of("Young's modulus [N/m] | step [s] | steps [1] | error of the way or the speed [1]");
  PortableScene scene = soft_sheet("");
  for (const double dt : {1e-4, 0.003, 0.012, 1.0 / 60, drawn("long step", 0.035, 0.05), 0.11})
    for (const long count : {1, 7})
      measured.row(scene.material.young, dt, count,
                   thrown_sideways(trial, scene, dt, count).wrong_time);
  for (const double young : {1.0, 30.0, 900.0})
    for (const double dt : {1.0 / 60, drawn("long step of a stiff sheet", 0.02, 0.03)}) {
      scene.material.young = young;
      const Thrown thrown = thrown_sideways(trial, scene, dt, 3);
      if (thrown.deformed < 0.01) measured.row(young, dt, 3, thrown.wrong_time);
    }
  return judge_worst(measured, 0.05, "the size of gravity is another law's, and rounding is less");
}

/// Of steps of `dt`, after a preparation that names other ones.
Finding dt_of_advance_counts(Trial& trial, const PortableScene& scene) {
  Table measured = table_of(
      "step in prepare [s] | in advance [s] | difference of positions [m] | over rounding [1]");
  for (const double times : {drawn("another step", 0.4, 0.7), 1.4}) {
    PortableScene other = scene;
    other.dt *= times;
    trial.prepare(other);
    const PerParticle3 x = trial.solver().advance(scene.dt, steps).x;
    const double off = largest(x - trial.after(scene, steps).x);
    measured.row(other.dt, scene.dt, off,
                 off / largest(scene.x) / (2 * narrow_rounding(trial, scene, steps)));
  }
  return judge_worst(measured, 1, "steps of the same length; both runs round differently");
}

/// Steps of one length, then of another, and none.
Finding each_call_has_its_step(Trial& trial) {
  PortableScene scene = soft_sheet("sheet thrown sideways, in steps of two lengths");
  scene.v.colwise() = Vector3(2.7, -1.3, 0.8);
  Table measured = table_of("step before [s] | step [s] | steps [1] | error of the way [1]");
  for (const auto& [first, second, count] :
       {std::tuple(0.002, drawn("second step", 0.007, 0.012), 3L),
        {0.01, 0.0015, 20L},
        {0.004, 0.004, 0L}}) {
    scene.dt = first;
    trial.prepare(scene);
    const PerParticle3 from = trial.solver().advance(first, 4).x,
                       to = trial.solver().advance(second, count).x;
    const Vector3 way = (to - from).rowwise().mean(), due = double(count) * second * scene.v.col(0);
    measured.row(first, second, count,
                 (way - due).norm() / (std::max(count, 1L) * second) / scene.v.col(0).norm());
  }
  return judge_worst(measured, free_enough, "no force of note acts: the way is v t");
}

/// A stiff sheet in long steps, where the solver bears them: it does so after short ones, too.
Finding long_steps_follow_short_ones(Trial& trial) {
  constexpr long few = 6;
  Table measured = table_of(
      "long step [s] | speed of parts by long steps [m/s] | after short ones, too [m/s] | "
      "over what is allowed [1]");
  for (const double dt : {0.001, 0.004, drawn("long steps after short ones", 0.015, 0.02)}) {
    PortableScene scene = deforming_sheet(1, 2);
    scene.name = "stiff sheet in steps of two lengths";
    scene.material.young = 200;
    const auto speed = [&](long before) {
      scene.dt = before > 0 ? 1e-5 : dt;
      trial.prepare(scene);
      if (before > 0) trial.solver().advance(scene.dt, before);
      return largest(trial.solver().advance(dt, few).v);
    };
    const double alone = speed(0), start = largest(scene.v);
    if (!(alone < 10 * start)) continue;  // it needs shorter steps
    const double after = speed(3);
    measured.row(dt, alone, after, after / (10 * start));
  }
  if (measured.rows() == 0) throw NotOffered{"steps of 1 ms for a sheet of 200 N/m"};
  return judge_worst(measured, 1, "empirical: what is stable does not grow to ten times its speed");
}

}  // namespace

std::vector<Law> limit_laws() {
  return {
      {"limits.no-speed-is-too-fast",
       "A sheet that drifts at 3 to 200 m/s goes as far as its speed says: no speed is clamped.",
       "Newton's first law", no_speed_is_too_fast, "", "speed | error of the path"},
      {"limits.no-edge-is-too-fast",
       "Ends of edges that part at 0.6 to 40 m/s go on: no speed of an edge is clamped, or damped.",
       "Newton's first law", no_edge_is_too_fast, "", "sheet | speed of an edge's ends | error"},
      {"limits.no-strain-is-too-large",
       "A very soft sheet is deformed by its inertia up to strains of 60 %: no strain is limited.",
       "Newton's first law", no_strain_is_too_large, "", "sheet | strain | error"},
      {"limits.no-step-takes-velocity",
       "What is left of a velocity does not depend on the number of steps: none scales it.",
       "Newton's first law", no_step_takes_velocity, "", "motion | difference"},
      {"limits.velocity-is-kept-for-thousands-of-steps",
       "Velocities of 2,600 steps are those of the first 500: none fades, and gravity goes on.",
       "Newton's laws", velocity_is_kept_for_thousands_of_steps, "", "motion | time"},
      {"gravity.is-that-of-the-scene",
       "Gravity of any size and direction gives the velocity g t: it is not the solver's own.",
       "Newton's second law", gravity_is_that_of_the_scene, "",
       "gravity | error of the mean velocity"},
      {"time.steps-last-as-long-as-asked",
       "Steps of 0.1 ms to 0.1 s, of soft or stiff sheets, last as long as asked: none is clamped, "
       "or of the solver's own, and no substep is lost.",
       "protocol: 'advance'", steps_last_as_long_as_asked, "", "Young's modulus | step | steps"},
      {"time.dt-of-advance-counts",
       "The step is that of `advance`, where `prepare` had another one.", "protocol: 'advance'",
       in_scene(dt_of_advance_counts, moving_sheet), "L1"},
      {"time.dt-of-advance-counts-for-dampers",
       "Dampers act for the step of `advance`, where `prepare` had another one.",
       "protocol: 'advance'", in_scene(dt_of_advance_counts, damped_moving_sheet), "L1 damping"},
      {"time.long-steps-follow-short-ones",
       "Long steps that are stable are stable after short ones, too.", "protocol: 'advance'",
       long_steps_follow_short_ones, "L1",
       "long step | speed of parts by long steps | after short ones, too"},
      {"time.each-call-has-its-step",
       "After steps of one length, `advance` by another, or by none, goes as far as it says.",
       "protocol: 'advance'", each_call_has_its_step, "L1"},
  };
}

}  // namespace foldproof
