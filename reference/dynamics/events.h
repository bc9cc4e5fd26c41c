// Events: times at which the velocity of what is led, or of an object, jumps: a prescribed motion
// starts or stops, a keyframe or a frame of an animation is passed; and those at which something
// starts or ceases to be sticky.
#pragma once

#include <memory>
#include <vector>

#include "reference/dynamics/system.h"

namespace foldproof {

/// The times after `start` at which the velocity of an object jumps, in any order, some perhaps
/// more than once [s].
std::vector<double> object_event_times(const System& system, double start);

/// The times after `start` at which a sticky patch becomes active, or is no longer, or
/// begins to let go [s].
std::vector<double> sticking_event_times(const System& system, double start);

/// The system of a run from event to event. Between two of them every prescribed motion is smooth;
/// that of led particles goes on smoothly beyond either, so that no step has to ask on which side
/// of an event it is. Objects are asked for their mean velocity over a step, which knows no sides,
/// and at its end for that of the instant, of which an event gives the later side.
class Events {
 public:
  /// Of a run from `start` [s]. Events closer together than `tolerance` [s] are taken as one.
  Events(const System& system, double start, double tolerance);

  /// Of the same run, from the time at which events were last passed (`last`) on.
  Events(const System& system, double start, double tolerance, double last);

  /// When events were last passed [s]; the start, if none was. What is led depends on it
  /// to the last bit.
  double last() const { return last_; }

  /// When the next event is due [s]; infinite if there is none.
  double next() const;

  /// The system until then. It stays where it is; `pass_events` changes it.
  const System& system() const { return own_ ? *own_ : given_; }

  /// The state s after all events due by its time: led particles have the velocities of
  /// their new motions.
  State pass_events(State s);

 private:
  void set_prescribed_motion(double t);
  void pass(double t);

  const System& given_;
  std::unique_ptr<System> own_;  // a copy, if led particles have any event
  std::vector<double> times_;    // still to come, ascending [s]
  double tolerance_;
  double last_;  // s
};

}  // namespace foldproof
