#include "reference/dynamics/simulate.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "reference/dynamics/events.h"
#include "reference/dynamics/settle.h"
#include "reference/fast/kept_values.h"
#include "reference/forces/degenerate.h"

namespace foldproof {

namespace {

// A particle that moves ten times the cloth's own size in one step counts as divergence.
constexpr double sizes_per_step = 10;

// Fraction of a frame interval: an event closer to a frame than this snaps to the frame, and a
// frame to the end, so no step is as short as rounding error.
constexpr double closest_event = 1e-9;

void check(const Schedule& schedule, const State& start) {
  if (!(schedule.end >= start.time))
    throw InputError("time: the end must not lie before the start");
  if (!(schedule.frame_interval > 0)) throw InputError("time: the frame interval must be > 0 s");
  if (!(schedule.step.fixed >= 0))
    throw InputError("time: the step must be > 0 s, or 0 for an automatic one");
  if (!(schedule.step.safety > 0)) throw InputError("time: the safety factor must be > 0");
  if (schedule.rest && !(schedule.rest->speed > 0 && schedule.rest->force > 0))
    throw InputError("time: the limits of rest must be > 0");
  if (!(schedule.step.strain_per_step > 0)) throw InputError("time: strain_per_step must be > 0");
}

/// The longest step in which no spring changes its length by more than `fraction` of its
/// rest length [s].
double step_by_strain_rate(const System& system, const State& s, double fraction,
                           const Work& work) {
  double fastest = 0;  // 1/s
  for_each_force(system.forces, s, *shapes_at(system.forces, s.x, work),
                 [&](const auto& force, const auto&... at) {
                   if constexpr (requires { force.fastest_strain_rate(at...); })
                     fastest = std::max(fastest, force.fastest_strain_rate(at...));
                 });
  return fraction / fastest;
}

double diagonal_of(const PerParticle3& x) {
  return (x.rowwise().maxCoeff() - x.rowwise().minCoeff()).norm();
}

/// The defect of `next`, if any: values that are not finite, or a jump.
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
  return Stop{"divergence: a particle moved more than ten times the cloth's size in one step",
              now.time, step, worst};
}

/// limit: the elastic limit [s].
double automatic_step(const System& system, const Integrator& integrator, const State& s,
                      const StepRule& rule, double limit, Work uncounted) {
  if (integrator.damping_widens_limit) limit = widened_limit(system, s, limit, uncounted);
  if (integrator.family == Family::fully_explicit) {
    const double rate =
        damping_rate_bound(*damping_at(system.forces, s, uncounted), system.inverse_mass);
    limit = std::min(limit, 2 / rate);
    if (std::isnan(rate)) limit = rate;
  }
  const double wanted = std::min(rule.safety * limit,
                                 step_by_strain_rate(system, s, rule.strain_per_step, uncounted));
  if (std::isnan(wanted))
    throw DegenerateElement("the elastic limit of the step is not a number", {-1});
  return wanted;
}

/// The longest step that divides the time `left` evenly and is no longer than `wanted` [s]. A small
/// tolerance makes 0.1 s in steps of 0.01 s take 10 steps, not 11.
double even_step(double left, double wanted) {
  const double parts = std::ceil(left / wanted * (1 - 1e-9));
  return parts <= 1 ? left : left / parts;
}

/// A run under way: it starts, steps from frame to frame, and stops.
class Run {
 public:
  /// Restores the run at the checkpoint.
  Run(const System& system, const Integrator& integrator, const Schedule& schedule,
      const Observer& observer, const Checkpoint& from);

  /// Reports the start: its frame, row and checkpoint.
  void start();

  /// Steps until the end or a failure, and reports every frame on the way.
  RunResult finish();

 private:
  void step_to_frame(double target);
  void step_to(double target);
  void step(double target);
  bool is_at_rest();
  std::optional<double> prescribed_end(double target) const;
  void hand_out_row(const State& s, double h, double limit, const Work& work);
  void hand_out_checkpoint() const;
  double seconds() const;
  double damping_power(const State& s) const;
  Work new_work() const;

  const Integrator& integrator_;
  const Schedule& schedule_;
  const Observer& observer_;
  std::chrono::steady_clock::time_point clock_start_ = std::chrono::steady_clock::now();
  // stored in checkpoints
  Events events_;
  History history_;
  long frame_, steps_;
  Work work_;
  double start_time_;              // s
  double size_;                    // of the cloth at the start [m]
  double damping_work_;            // J
  double damping_power_;           // at the latest row [W]
  double seconds_before_;          // of clock time, in the part of the run before the checkpoint
  std::optional<Stop> stop_ = {};  // the failure, if any
  std::optional<Resting> rest_ = {};
  // values reused from step to step, for speed only
  std::shared_ptr<KeptValues> kept_ = std::make_shared<KeptValues>();
};

/// Nothing is counted yet.
Work Run::new_work() const {
  Work work;
  work.kept = kept_;
  return work;
}

Run::Run(const System& system, const Integrator& integrator, const Schedule& schedule,
         const Observer& observer, const Checkpoint& from)
    : integrator_(integrator),
      schedule_(schedule),
      observer_(observer),
      events_(system, from.start_time, closest_event * schedule.frame_interval, from.event_time),
      history_(from.past, integrator.history),
      frame_(from.frame),
      steps_(from.steps),
      work_(from.work),
      start_time_(from.start_time),
      size_(from.size),
      damping_work_(from.damping_work),
      damping_power_(from.damping_power),
      seconds_before_(from.seconds) {}

void Run::start() {
  const State& now = history_.now();
  if (observer_.frame) observer_.frame(now);
  try {
    if (observer_.step) hand_out_row(now, 0, elastic_limit(events_.system(), now, new_work()), {});
  } catch (const DegenerateElement& error) {
    stop_ = Stop{error.what(), now.time, 0, error.particles.front()};
    return;
  }
  hand_out_checkpoint();
}

RunResult Run::finish() {
  while (!stop_ && !is_at_rest() && history_.now().time < schedule_.end) {
    const double next_frame = start_time_ + double(frame_ + 1) * schedule_.frame_interval;
    const double close = closest_event * schedule_.frame_interval;
    step_to_frame(next_frame < schedule_.end - close ? next_frame : schedule_.end);
    if (stop_) break;
    ++frame_;
    if (observer_.frame) observer_.frame(history_.now());
    hand_out_checkpoint();
  }
  return {history_.now(), steps_, work_, stop_, rest_};
}

/// Measured only where the schedule asks for it.
bool Run::is_at_rest() {
  if (!schedule_.rest) return false;
  const System& system = events_.system();
  const State& now = history_.now();
  const double fixed = schedule_.step.fixed;
  const double h = fixed > 0 ? fixed : schedule_.step.safety * elastic_limit(system, now);
  Work uncounted;
  const Unbalanced left = largest_unbalanced(system, unbalanced_forces(system, now, h, uncounted));
  rest_ =
      Resting{now.v.colwise().norm().maxCoeff(), left.over_weight, what_moves(system, now.time)};
  if (rest_->moves.empty() && std::isfinite(events_.next())) rest_->moves = "something, later,";
  rest_->reached = rest_->speed < schedule_.rest->speed && rest_->force < schedule_.rest->force &&
                   rest_->moves.empty();
  return rest_->reached;
}

/// Steps to the time `target` across all events on the way; the history restarts after each.
void Run::step_to_frame(double target) {
  const double close = closest_event * schedule_.frame_interval;
  while (!stop_ && history_.now().time < target) {
    const double due = events_.next();
    step_to(due < target - close ? due : target);
    if (!stop_ && due <= history_.now().time + close)
      history_ = History(events_.pass_events(history_.now()), integrator_.history);
  }
}

/// Steps to the time `target`, with no event on the way.
void Run::step_to(double target) {
  while (!stop_ && history_.now().time < target) {
    const double time = history_.now().time;
    const long number = steps_ + 1;
    if (number > schedule_.max_steps) {
      stop_ = Stop{"the cap on the number of steps was reached", time, number, -1};
      return;
    }
    try {
      step(target);
    } catch (const DegenerateElement& error) {
      stop_ = Stop{error.what(), time, number, error.particles.front()};
    }
  }
}

/// The end of the next step if the schedule prescribes it, at most `target` [s]; else none.
std::optional<double> Run::prescribed_end(double target) const {
  const std::vector<double>& ends = schedule_.step.ends;
  const auto next = std::ranges::upper_bound(ends, history_.now().time);
  if (next == ends.end()) return {};
  return std::min(*next, target);
}

/// One step towards the time `target`.
void Run::step(double target) {
  const System& system = events_.system();
  State& now = history_.now();
  const long number = steps_ + 1;
  Work work = new_work();
  begin_step(system, now, work);
  const double left = target - now.time;
  const std::optional<double> end = prescribed_end(target);
  const bool asks_for_limit = observer_.step || !(end || schedule_.step.fixed > 0);
  const double limit = asks_for_limit ? elastic_limit(system, now, work) : 0;
  const double h = end ? *end - now.time
                       : even_step(left, allowed_step(system, integrator_, history_.past(),
                                                      schedule_.step, limit, work));
  if (!(now.time + h > now.time)) {
    stop_ = Stop{"a step became too short to advance the time", now.time, number, -1};
    return;
  }
  work.bonds = long(now.bonds.size());
  State next = integrator_.step(system, history_.past(), h, work);
  if (h == left) next.time = target;  // so that frame and state have the same time, bit for bit
  if (end) next.time = *end;
  stop_ = fault_in(now, next, size_, number);
  if (stop_) return;
  work.kept = nullptr;
  hand_out_row(next, h, limit, work);
  add(work_, work);
  history_.advance(std::move(next));
  ++steps_;
}

/// limit: the elastic limit where the step began [s].
void Run::hand_out_row(const State& s, double h, double limit, const Work& work) {
  if (!observer_.step) return;
  Diagnostics row;
  row.time = s.time;
  row.step = h;
  const System& system = events_.system();
  row.energy = energies(system, s, new_work());
  const double power = damping_power(s);
  damping_work_ += h / 2 * (damping_power_ + power);
  damping_power_ = power;
  row.damping_work = damping_work_;
  row.linear_momentum = linear_momentum(system, s);
  row.angular_momentum = angular_momentum(system, s);
  row.step_over_elastic_limit = h / limit;
  row.work = work;
  row.seconds = seconds();
  observer_.step(row);
}

void Run::hand_out_checkpoint() const {
  if (!observer_.checkpoint) return;
  observer_.checkpoint({.past = history_.past(),
                        .frame = frame_,
                        .steps = steps_,
                        .work = work_,
                        .start_time = start_time_,
                        .size = size_,
                        .event_time = events_.last(),
                        .damping_work = damping_work_,
                        .damping_power = damping_power_,
                        .seconds = seconds()});
}

/// Clock time since the start of the run.
double Run::seconds() const {
  const std::chrono::duration<double> since = std::chrono::steady_clock::now() - clock_start_;
  return seconds_before_ + since.count();
}

/// v.(D v) [W].
double Run::damping_power(const State& s) const {
  Work uncounted = new_work();
  const auto damping = damping_at(events_.system().forces, s, uncounted);
  if (damping->empty()) return 0;
  PerParticle3 force = PerParticle3::Zero(3, s.x.cols());
  damping->add_product(s.v, force);
  return force.cwiseProduct(s.v).sum();
}

}  // namespace

double allowed_step(const System& system, const Integrator& integrator, std::span<const State> past,
                    const StepRule& rule, double limit, const Work& work) {
  double wanted = rule.fixed > 0
                      ? rule.fixed
                      : automatic_step(system, integrator, past.back(), rule, limit, work);
  if (past.size() > 1) {
    const double before = past.back().time - past[past.size() - 2].time;
    wanted = std::min(wanted, integrator.largest_growth * before);
  }
  return wanted;
}

RunResult simulate(const System& system, const Integrator& integrator, const State& start,
                   const Schedule& schedule, const Observer& observer) {
  check(schedule, start);
  Checkpoint at_start;
  at_start.past = {start};
  at_start.start_time = at_start.event_time = start.time;
  at_start.size = diagonal_of(start.x);
  Run run(system, integrator, schedule, observer, at_start);
  run.start();
  return run.finish();
}

RunResult resume(const System& system, const Integrator& integrator, const Checkpoint& from,
                 const Schedule& schedule, const Observer& observer) {
  if (from.past.empty() || from.past.back().x.cols() != system.mass.size())
    throw InputError("a checkpoint without a state, or of another number of particles");
  check(schedule, from.past.back());
  return Run(system, integrator, schedule, observer, from).finish();
}

}  // namespace foldproof
