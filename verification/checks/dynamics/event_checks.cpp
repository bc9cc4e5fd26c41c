// Events: prescribed motions that start and stop during a run, and how the run handles them.
#include "reference/dynamics/simulate.h"
#include "reference/mesh/shapes.h"
#include "verification/oracles/exact_solutions.h"
#include "verification/specimens/check.h"
#include "verification/specimens/followed_runs.h"

namespace foldproof {

namespace {

// A particle on a damped spring of zero length whose other end is prescribed: it starts at one time
// and stops at another.
constexpr double mass = 0.37, stiffness = 5.3, damping = 1.9;            // kg, N/m, N s/m
constexpr double from = 0.2371, until = 0.6193, end = 0.9, speed = 1.7;  // s, s, s, m/s
constexpr double start_x = 0.23, start_v = -0.41;                        // m, m/s

void add_pull(const PerParticle3& a, double coefficient, PerParticle3& f) {
  const Vector3 pull = coefficient * (a.col(1) - a.col(0));
  f.col(0) += pull;
  f.col(1) -= pull;
}

System led_spring() {
  System system = make_system(PerParticle::Constant(2, mass));
  CustomForce force;
  force.elastic = [](const State& s, PerParticle3& f) { add_pull(s.x, stiffness, f); };
  force.damping = [](const State&) -> DampingOperator::Custom {
    return {[](const PerParticle3& v, PerParticle3& f) { add_pull(v, damping, f); }, {}};
  };
  force.differential = [](const State&, Definiteness) {
    return [](const PerParticle3& dx, PerParticle3& df) { add_pull(dx, stiffness, df); };
  };
  system.forces.push_back(force);
  Motion motion;
  motion.velocity = Vector3(speed, 0, 0);
  motion.from = from;
  motion.until = until;
  prescribe(system, {0, Vector3::Zero(), motion});
  system.solver.tolerance = 1e-13;
  return system;
}

State start_of_spring() {
  State s{0, PerParticle3::Zero(3, 2), PerParticle3::Zero(3, 2)};
  s.x(0, 1) = start_x;
  s.v(0, 1) = start_v;
  return s;
}

/// Position [m] and velocity [m/s] of the free particle relative to the prescribed one.
struct Relative {
  double x, v;
};

Relative after(const Relative& at, double t) {
  const oracles::OscillatorEstimate exact =
      oracles::oscillator_at({stiffness / mass, damping / mass, at.x, at.v}, t);
  return {exact.x.value, exact.v.value};
}

/// Relative to the prescribed end, now at rest: a free oscillation whose velocity changes at each
/// event.
Relative exact_end() {
  Relative at = after({start_x, start_v}, from);
  at.v -= speed;
  at = after(at, until - from);
  at.v += speed;
  return after(at, end - until);
}

/// Error at the end in sqrt(energy/stiffness) [m], with steps of at most h [s].
double error_at(const System& system, const Integrator& integrator, double h) {
  const State last =
      simulate(system, integrator, start_of_spring(), {end, end, {h, 0.5, 0.1}, 100000}, {}).last;
  const Relative exact = exact_end();
  const double dx = last.x(0, 1) - last.x(0, 0) - exact.x,
               dv = last.v(0, 1) - last.v(0, 0) - exact.v;
  return std::sqrt(dx * dx + mass / stiffness * dv * dv);
}

Finding order_holds() {
  const System system = led_spring();
  Table measured{{"case", ""}, {"|observed order - order of the table|", "1"}};
  for (const Integrator& integrator : integrators()) {
    const double coarse = error_at(system, integrator, 0.0041),
                 fine = error_at(system, integrator, 0.00205);
    measured.row(std::string(integrator.name),
                 std::abs(std::log2(coarse / fine) - integrator.order));
  }
  return judge_worst(measured, 0.1,
                     "a step across an event would err by the first or second power of the step, "
                     "so that an order of two or more would be off by 1 at least; at fiftieths of "
                     "the decay the next term leaves a tenth");
}

const Schedule ten_frames{end, 0.1, {0.013, 0.5, 0.1}, 100000};

/// A row for each event: its distance from the nearest end of a step of the run [s].
void see_events(const System& system, std::string_view integrator,
                const std::vector<double>& events, Table& measured) {
  const Followed run =
      followed_run(system, integrator_named(integrator), start_of_spring(), ten_frames);
  for (const double event : events) {
    double nearest = INFINITY;
    for (const Diagnostics& row : run.rows) nearest = std::min(nearest, std::abs(row.time - event));
    measured.row(std::string(integrator) + ", at " + std::to_string(event) + " s", nearest);
  }
}

Finding judged_events(const Table& measured) {
  return judge_worst(measured, 0, "the state that ends at an event has its time to the bit");
}

Table no_events() {
  return {{"case", ""}, {"distance of an event from the nearest end of a step", "s"}};
}

Finding events_are_hit() {
  const System system = led_spring();
  Table measured = no_events();
  for (const Integrator& integrator : integrators())
    see_events(system, integrator.name, {from, until}, measured);
  return judged_events(measured);
}

/// Far from the spring: a ball, a cube moved by keyframes and a ball that deforms, with the times
/// at which their motions jump.
struct Movers {
  ObjectCollision collision;
  std::vector<double> times;  // s
};

Movers movers() {
  Motion motion;
  motion.velocity = Vector3(0.3, 0, 0);
  motion.from = 0.1417;
  motion.until = 0.5773;
  const Vector3 away(50, 0, 0);
  const Keyframes keys =
      make_keyframes({{0.0713, {}}, {0.3331, {Eigen::Quaterniond::Identity(), away}}});
  const auto grown = [](const Vector3& X, double t) -> Vector3 { return (1 + t) * X; };
  const MeshSequence sequence = deformed_mesh(make_icosphere(0.1, 1), grown, {0, 0.2113, 0.7177});
  const OctreeSettings coarse{Vector3::Constant(-0.5),  1, 4, 2, 0.01, 0.1, 1, 0,
                              HangingNodes::constrained};
  const Pose place{Eigen::Quaterniond::Identity(), away};
  Movers all;
  all.collision.objects = {{"ball", RigidObject{Sphere{0.1}, place, motion}, 0},
                           {"cube", RigidObject{Box{Vector3::Constant(0.1)}, place, keys}, 0},
                           {"grown",
                            DeformingObject{std::make_shared<DeformingBody>(
                                make_deforming_body(sequence, coarse, BetweenFrames::carried))},
                            0}};
  all.times = {0.1417, 0.5773, 0.0713, 0.3331, 0.2113, 0.7177};
  return all;
}

Finding object_events_are_hit() {
  const Movers objects = movers();
  System system = led_spring();
  system.filters.push_back(objects.collision);
  Table measured = no_events();
  for (const char* integrator : {"A", "C", "BDF2", "RK4"})
    see_events(system, integrator, objects.times, measured);
  return judged_events(measured);
}

/// A motion that drifts and swings between two times, one of them a rounding away from a frame.
Finding path_is_kept() {
  System system = led_spring();
  Motion& motion = system.prescribed.front().motion;
  motion.amplitude = Vector3(0.07, -0.03, 0.05);
  motion.frequency = 1.9;
  motion.phase = 0.6;
  motion.from = 0.1 + 0.1 + 0.1;  // one rounding above 0.3
  Table measured{{"case", ""}, {"distance from the path, or of velocities, over the swing", "1"}};
  for (const Integrator& integrator : integrators()) {
    const Followed run = followed_run(system, integrator, start_of_spring(), ten_frames);
    Worst x, v;
    for (const State& s : run.frames) {
      const double acted = std::clamp(s.time + 1e-12, motion.from, until) - motion.from;
      const double angle = 2 * EIGEN_PI * motion.frequency * acted + motion.phase;
      const Vector3 place =
          acted * motion.velocity + (std::sin(angle) - std::sin(motion.phase)) * motion.amplitude;
      const bool moves = s.time + 1e-12 >= motion.from && s.time < until;
      const Vector3 rate =
          motion.velocity + 2 * EIGEN_PI * motion.frequency * std::cos(angle) * motion.amplitude;
      x.observe((s.x.col(0) - place).norm());
      v.observe((s.v.col(0) - (moves ? rate : Vector3::Zero())).norm() /
                (2 * EIGEN_PI * motion.frequency));
    }
    measured.row(std::string(integrator.name) + ", positions", x.value() / motion.amplitude.norm());
    measured.row(std::string(integrator.name) + ", velocities",
                 v.value() / motion.amplitude.norm());
  }
  return judge_worst(measured, 1e-9,
                     "frame times differ from the formula's by up to 1e-12 s here, in which a 2 Hz "
                     "oscillation changes by 1e-11 of itself, and the drift by 1e-11 too");
}

}  // namespace

std::vector<Check> event_checks() {
  const std::string ours = "our reading of BMF03 section 3; Hairer, Norsett, Wanner, section II.6";
  return {{"dynamics.order-holds-across-events",
           "Runs of the reference keep the order of every method while a prescribed motion starts "
           "and stops.",
           ours, order_holds},
          {"dynamics.events-are-hit-exactly",
           "A step of the reference ends where a prescribed motion starts or stops.", ours,
           events_are_hit},
          {"dynamics.events-of-objects-are-hit-exactly",
           "A step of the reference ends where an object starts or stops, passes a keyframe or a "
           "frame of its animation.",
           ours, object_events_are_hit},
          {"dynamics.prescribed-particles-rest-outside-their-time-span",
           "A prescribed particle rests before its motion starts, follows its path from then on, "
           "and rests after it stops; a frame at the start has the later velocity.",
           ours, path_is_kept}};
}

}  // namespace foldproof
