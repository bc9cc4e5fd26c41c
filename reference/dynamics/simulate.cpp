#include "reference/dynamics/simulate.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "reference/dynamics/events.h"
#include "reference/forces/degenerate.h"

namespace foldproof {

namespace {

// A particle that crosses ten times the cloth's own size in one step is taken for divergence.
constexpr double sizes_per_step = 10;

// Of a frame's interval: an event as close to a frame as this happens at it, lest a step be as short as a
// rounding.
constexpr double closest_event = 1e-9;

void check(const Schedule& schedule, const State& start) {
  if (!(schedule.end >= start.time)) throw InputError("time: the end must not lie before the start");
  if (!(schedule.frame_interval > 0)) throw InputError("time: the frame interval must be > 0 s");
  if (!(schedule.step.fixed >= 0))
    throw InputError("time: the step must be > 0 s, or 0 for an automatic one");
  if (!(schedule.step.safety > 0)) throw InputError("time: the safety factor must be > 0");
  if (!(schedule.step.strain_per_step > 0)) throw InputError("time: strain_per_step must be > 0");
}

/// The longest step in which no spring changes its length by more than `fraction` of its rest length [s].
double step_by_strain_rate(const System& system, const State& s, double fraction) {
  double fastest = 0;  // 1/s
  for (const Force& force : system.forces) {
    const auto* stretch = std::get_if<StretchSprings>(&force);
    if (!stretch) continue;
    for (const Spring& spring : stretch->springs) {
      const Vector3 d = s.x.col(spring.b) - s.x.col(spring.a);
      const double rate = d.dot(s.v.col(spring.b) - s.v.col(spring.a)) / d.norm();
      fastest = std::max(fastest, std::abs(rate) / spring.rest_length);
    }
  }
  return fraction / fastest;
}

double diagonal_of(const PerParticle3& x) { return (x.rowwise().maxCoeff() - x.rowwise().minCoeff()).norm(); }

/// What is wrong with `next`, if anything: values that are not finite, or a leap.
std::optional<Stop> fault_in(const State& now, const State& next, double size, long step) {
  int worst = -1;
  double farthest = sizes_per_step * size;
  for (Eigen::Index i = 0; i < next.x.cols(); ++i) {
    if (!next.x.col(i).allFinite() || !next.v.col(i).allFinite())
      return Stop{"NaN or infinite values", now.time, step, int(i)};
    const double moved = (next.x.col(i) - now.x.col(i)).norm();
    if (moved > farthest) {
      farthest = moved;
      worst = int(i);
    }
  }
  if (worst < 0) return {};
  return Stop{"divergence: a particle moved more than ten times the cloth's size in one step", now.time, step,
              worst};
}

class Watch {
 public:
  /// from: where the run starts, or goes on.
  Watch(const System& system, const Observer& observer, const Checkpoint& from)
      : system_(system),
        observer_(observer),
        size_(from.size),
        seconds_before_(from.seconds),
        damping_work_(from.damping_work),
        power_before_(from.damping_power) {}

  double size() const { return size_; }  // of the cloth at the start [m]

  void frame(const State& s) const {
    if (observer_.frame) observer_.frame(s);
  }

  /// Hands the run's checkpoint on, with what the watch itself remembers.
  void checkpoint(const std::function<Checkpoint()>& of_run) const {
    if (!observer_.checkpoint) return;
    Checkpoint now = of_run();
    now.size = size_;
    now.damping_work = damping_work_;
    now.damping_power = power_before_;
    now.seconds = seconds();
    observer_.checkpoint(now);
  }

  bool wants_rows() const { return bool(observer_.step); }

  /// limit: the elastic limit where the step began [s].
  void step(const State& s, double h, double limit, const Work& work) {
    if (!wants_rows()) return;
    Diagnostics row;
    row.time = s.time;
    row.step = h;
    row.energy = energies(system_, s);
    const double power = damping_power(s);
    damping_work_ += h / 2 * (power_before_ + power);
    power_before_ = power;
    row.damping_work = damping_work_;
    row.linear_momentum = linear_momentum(system_, s);
    row.angular_momentum = angular_momentum(system_, s);
    row.step_over_elastic_limit = h / limit;
    row.work = work;
    row.seconds = seconds();
    observer_.step(row);
  }

 private:
  double seconds() const {  // since the start of the run
    return seconds_before_ + std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

  double damping_power(const State& s) const {  // v.(D v) [W]
    Work uncounted;
    PerParticle3 force = PerParticle3::Zero(3, s.x.cols());
    damping_at(system_.forces, s, uncounted).add_product(s.v, force);
    return force.cwiseProduct(s.v).sum();
  }

  const System& system_;
  const Observer& observer_;
  double size_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  double seconds_before_;  // of clock time, in the part of the run before a checkpoint
  double damping_work_, power_before_;
};

/// What a run is made of.
struct Run {
  const Integrator& integrator;
  const Schedule& schedule;
  Watch& watch;
  Events events;
  History history;
  Outcome outcome;

  Checkpoint checkpoint(long frame, double start_time) const {
    return {history.past(), frame, outcome.steps, outcome.work, start_time, 0, events.last(), 0, 0, 0};
  }
};

/// A run as it is at the checkpoint.
Run run_from(const Checkpoint& from, const System& system, const Integrator& integrator,
             const Schedule& schedule, Watch& watch) {
  const double tolerance = closest_event * schedule.frame_interval;
  Outcome outcome;
  outcome.steps = from.steps;
  outcome.work = from.work;
  return {integrator,
          schedule,
          watch,
          {system, from.start_time, tolerance, from.event_time},
          {from.past, integrator.history},
          std::move(outcome)};
}

/// The longest even part of the time `left` that is no longer than `wanted` [s]; a hair of tolerance so that
/// 0.1 s in steps of 0.01 s are 10 steps, not 11.
double even_part(double left, double wanted) {
  const double parts = std::ceil(left / wanted * (1 - 1e-9));
  return parts <= 1 ? left : left / parts;
}

/// Advances the history to the time `target` without an event, or sets outcome.stop.
void run_to(double target, Run& run) {
  auto& [integrator, schedule, watch, events, history, outcome] = run;
  const System& system = events.system();
  while (history.now().time < target && !outcome.stop) {
    State& now = history.now();
    const long number = outcome.steps + 1;
    if (number > schedule.max_steps) {
      outcome.stop = Stop{"the cap on the number of steps was reached", now.time, number, -1};
      return;
    }
    try {
      begin_step(system, now);
      const double left = target - now.time;
      const bool asks_for_limit = watch.wants_rows() || !(schedule.step.fixed > 0);
      const double limit = asks_for_limit ? elastic_limit(system, now) : 0;
      const double h =
          even_part(left, step_allowed(system, integrator, history.past(), schedule.step, limit));
      if (!(now.time + h > now.time)) {
        outcome.stop = Stop{"a step became too short to advance the time", now.time, number, -1};
        return;
      }
      Work work;
      work.bonds = long(now.bonds.size());
      State next = integrator.step(system, history.past(), h, work);
      if (h == left) next.time = target;  // no rounding between a frame's time and its state's
      outcome.stop = fault_in(now, next, watch.size(), number);
      if (outcome.stop) return;
      watch.step(next, h, limit, work);
      add(outcome.work, work);
      history.advance(std::move(next));
      ++outcome.steps;
    } catch (const DegenerateElement& error) {
      outcome.stop = Stop{error.what(), now.time, number, error.particles.front()};
    }
  }
}

/// Advances the history to the time `target` and across all events until then, after each of which it starts
/// anew.
void run_across_events(double target, Run& run) {
  const double close = closest_event * run.schedule.frame_interval;
  while (!run.outcome.stop && run.history.now().time < target) {
    const double due = run.events.next();
    run_to(due < target - close ? due : target, run);
    if (!run.outcome.stop && due <= run.history.now().time + close)
      run.history = History(run.events.passed(run.history.now()), run.integrator.history);
  }
}

/// Runs on from this frame, of a run that began at `start` [s].
Outcome run_to_end(long frame, double start, Run& run) {
  const Schedule& schedule = run.schedule;
  while (!run.outcome.stop && run.history.now().time < schedule.end) {
    ++frame;
    const double target = std::min(schedule.end, start + double(frame) * schedule.frame_interval);
    run_across_events(target, run);
    if (run.outcome.stop) break;
    run.watch.frame(run.history.now());
    run.watch.checkpoint([&] { return run.checkpoint(frame, start); });
  }
  run.outcome.last = run.history.now();
  return run.outcome;
}

/// limit: the elastic limit [s].
double automatic_step(const System& system, const Integrator& integrator, const State& s,
                      const StepRule& rule, double limit) {
  if (integrator.damping_widens_limit) limit = widened_limit(system, s, limit);
  if (integrator.family == Family::fully_explicit) {
    Work uncounted;
    const double rate = damping_rate_bound(damping_at(system.forces, s, uncounted), system.inverse_mass);
    limit = std::min(limit, 2 / rate);
    if (std::isnan(rate)) limit = rate;
  }
  const double wanted = std::min(rule.safety * limit, step_by_strain_rate(system, s, rule.strain_per_step));
  if (std::isnan(wanted)) throw DegenerateElement("the elastic limit of the step is not a number", {-1});
  return wanted;
}

}  // namespace

double step_allowed(const System& system, const Integrator& integrator, std::span<const State> past,
                    const StepRule& rule, double limit) {
  double wanted = rule.fixed > 0 ? rule.fixed : automatic_step(system, integrator, past.back(), rule, limit);
  if (past.size() > 1) {
    const double before = past.back().time - past[past.size() - 2].time;
    wanted = std::min(wanted, integrator.largest_growth * before);
  }
  return wanted;
}

Outcome simulate(const System& system, const Integrator& integrator, const State& start,
                 const Schedule& schedule, const Observer& observer) {
  check(schedule, start);
  Checkpoint at_start;
  at_start.past = {start};
  at_start.start_time = at_start.event_time = start.time;
  at_start.size = diagonal_of(start.x);
  Watch watch(system, observer, at_start);
  Run run = run_from(at_start, system, integrator, schedule, watch);
  watch.frame(start);
  try {
    if (watch.wants_rows()) watch.step(start, 0, elastic_limit(system, start), {});
  } catch (const DegenerateElement& error) {
    run.outcome.stop = Stop{error.what(), start.time, 0, error.particles.front()};
  }
  if (!run.outcome.stop) watch.checkpoint([&] { return run.checkpoint(0, start.time); });
  return run_to_end(0, start.time, run);
}

Outcome resume(const System& system, const Integrator& integrator, const Checkpoint& from,
               const Schedule& schedule, const Observer& observer) {
  if (from.past.empty() || from.past.back().x.cols() != system.mass.size())
    throw InputError("a checkpoint without a state, or of another number of particles");
  check(schedule, from.past.back());
  Watch watch(system, observer, from);
  Run run = run_from(from, system, integrator, schedule, watch);
  return run_to_end(from.frame, from.start_time, run);
}

}  // namespace foldproof
