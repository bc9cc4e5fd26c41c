// Events: times at which a prescribed velocity or an object's velocity jumps (a prescribed
// motion starts or stops; a keyframe or animation frame is passed), or at which a patch starts
// or stops being sticky.
#pragma once

#include <memory>
#include <vector>

#include "reference/dynamics/system.h"

namespace foldproof {

/// The times after `start` at which the velocity of an object jumps, in any order, some perhaps
/// more than once [s].
std::vector<double> object_event_times(const System& system, double start);

/// The times after `start` at which a sticky patch becomes active, becomes inactive, or begins
/// its release [s].
std::vector<double> sticking_event_times(const System& system, double start);

/// The system of a run, from event to event. Between two events every prescribed motion is smooth.
/// The motion of prescribed particles continues smoothly past both, so no step needs to know on
/// which side of an event it lies. Objects return their mean velocity over a step, which has no
/// sides, and at its end their instantaneous velocity, which at an event is the later one.
class Events {
 public:
  /// For a run from `start` [s]. Events closer together than `tolerance` [s] count as one.
  Events(const System& system, double start, double tolerance);

  /// For the same run, resumed from the time of the last event passed (`last`).
  Events(const System& system, double start, double tolerance, double last);

  /// Time of the last event passed [s]; the start if there was none. Prescribed motions depend on
  /// it to the last bit.
  double last() const { return last_; }

  /// Time of the next event [s]; infinite if there is none.
  double next() const;

  /// The system until then. Its address is stable; `pass_events` modifies it.
  const System& system() const { return own_ ? *own_ : given_; }

  /// The state s after all events due by its time: prescribed particles have the velocities of
  /// their new motions.
  State pass_events(State s);

 private:
  void set_prescribed_motion(double t);
  void pass(double t);

  const System& given_;
  std::unique_ptr<System> own_;  // a copy, if prescribed particles have any event
  std::vector<double> times_;    // still to come, ascending [s]
  double tolerance_;
  double last_;  // s
};

}  // namespace foldproof
