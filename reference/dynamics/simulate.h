// A run: steps from frame to frame, with diagnostics, until the end or a failure.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "reference/dynamics/integrator.h"
#include "reference/dynamics/system.h"

namespace foldproof {

/// Rule for the step size. Each frame interval (or, for automatic steps, the rest of it) is divided
/// evenly, so frames are hit exactly. So are events, at which a prescribed motion starts or stops
/// or an object's velocity jumps (dynamics/events.h); multistep methods restart there.
struct StepRule {
  double fixed = 0;  // the largest step allowed [s]; 0: automatic
  // automatic: fraction of the elastic limit 2/omega, and for fully explicit methods also of the
  // damping limit 2/c, where c bounds the largest damping rate [1]
  double safety = 0.5;
  // automatic: no edge's length changes by more than this fraction of its rest length [1]
  double strain_per_step = 0.1;
  // end times of the steps, ascending, including frames and events [s]; after the last one, or if
  // empty, the rules above apply
  std::vector<double> ends = {};
};

/// A run may end before its time: at the first frame, the start included, at which every particle
/// is slower and less unbalanced (dynamics/settle.h) than this, and nothing that holds or touches
/// the cloth moves or will.
struct RestLimits {
  double speed = 1e-4;  // m/s
  double force = 1e-3;  // what the filters leave on a particle, over its weight [1]
};

struct Schedule {
  double end = 1;             // s
  double frame_interval = 1;  // s
  StepRule step;
  long max_steps = 100'000'000;         // a run that reaches it stops and reports it
  std::optional<RestLimits> rest = {};  // none: the run goes on to its end
};

/// One row of diagnostics, taken after a step; the first row is the start.
struct Diagnostics {
  double time = 0, step = 0;  // s
  Energies energy;            // J
  double damping_work = 0;    // work done by the damping forces so far, by the trapezoidal rule [J]
  Vector3 linear_momentum, angular_momentum;  // kg m/s, kg m^2/s about the origin
  double step_over_elastic_limit = 0;         // at the state from which the step started [1]
  Work work;                                  // of this step
  double seconds = 0;                         // since the start of the run, clock time
};

/// Calls `visit` with every number of a Diagnostics (const or not) except the clock time, in a
/// fixed order: counts as long, the rest as double.
template <class SomeDiagnostics, class Visit>
void for_each_value(SomeDiagnostics& d, const Visit& visit) {
  for (auto* value : {&d.time, &d.step, &d.damping_work, &d.step_over_elastic_limit}) visit(*value);
  for (auto term : energy_terms) visit(d.energy.*term);
  for (auto* momentum : {&d.linear_momentum, &d.angular_momentum})
    for (auto& component : *momentum) visit(component);
  for_each_counter(d.work, visit);
}

// Visit every new number above.
static_assert(sizeof(Diagnostics) == sizeof(Energies) + sizeof(Work) + 11 * sizeof(double));

struct Stop {
  std::string reason;
  double time;   // of the last good state [s]
  long step;     // number of the step that failed, from 1; 0: the start
  int particle;  // the worst particle, -1 if no single one is the cause
};

/// How near rest a state is, in words where it is not there.
struct Resting {
  double speed = 0, force = 0;  // the largest, as in RestLimits
  std::string moves = {};       // what holds or touches the cloth and moves or will; or ""
  bool reached = false;
};

struct RunResult {
  State last;  // the last good state
  long steps = 0;
  Work work;
  std::optional<Stop> stop;          // empty when the end, or rest, was reached
  std::optional<Resting> rest = {};  // of the last frame, if the schedule asks for it
};

/// The state of a run at a frame, without its system, method and schedule: enough to resume bit for
/// bit.
struct Checkpoint {
  std::vector<State> past;    // history of the method; the latest is the frame's state
  long frame = 0, steps = 0;  // so far; the start is frame 0
  Work work;                  // of all steps so far
  double start_time = 0;      // of the run [s]
  double size = 0;            // of the cloth at the start, the scale for detecting jumps [m]
  double event_time = 0;      // time of the last event passed; the start if there was none [s]
  double damping_work = 0;    // J
  double damping_power = 0;   // at the frame [W]
  double seconds = 0;         // clock time since the start of the run
};

/// Callbacks of a run. Empty functions are not called, and unobserved diagnostics are not computed.
struct Observer {
  std::function<void(const State&)> frame;  // at 0, every frame interval, and the end
  std::function<void(const Diagnostics&)> step;
  // after each frame and its row of diagnostics
  std::function<void(const Checkpoint&)> checkpoint = {};
};

/// Throws InputError for an invalid schedule (end < start, interval <= 0, safety <= 0, ...).
RunResult simulate(const System& system, const Integrator& integrator, const State& start,
                   const Schedule& schedule, const Observer& observer);

/// Resumes from a checkpoint of a run of the same system, integrator and schedule with the same
/// callbacks set. Frames, diagnostics (except clock time), later checkpoints and the result match
/// the uninterrupted run bit for bit; callbacks made before the checkpoint are not repeated. Throws
/// InputError for a checkpoint without a state or with a different number of particles.
RunResult resume(const System& system, const Integrator& integrator, const Checkpoint& from,
                 const Schedule& schedule, const Observer& observer);

/// The longest step [s] that the rule allows after these states. The ratio of a step to the
/// previous one never exceeds the integrator's largest_growth.
///   limit   the elastic limit at the latest of them [s]; not used by a rule with a fixed step
double allowed_step(const System& system, const Integrator& integrator, std::span<const State> past,
                    const StepRule& rule, double limit, const Work& work = {});

}  // namespace foldproof
