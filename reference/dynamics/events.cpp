#include "reference/dynamics/events.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace foldproof {

namespace {

std::vector<double> jumps_of(const Motion& motion) { return {motion.from, motion.until}; }

std::vector<double> jumps_of(const Keyframes& motion) {
  std::vector<double> times;
  for (const Keyframe& frame : motion.keys) times.push_back(frame.time);
  return times;
}

std::vector<double> jumps_of(const RigidObject& body) {
  return std::visit([](const auto& motion) { return jumps_of(motion); }, body.motion);
}

std::vector<double> jumps_of(const DeformingObject& object) {
  std::vector<double> times;
  for (const DeformingFrame& frame : object.body->frames) times.push_back(frame.time);
  return times;
}

}  // namespace

std::vector<double> object_event_times(const System& system, double start) {
  std::vector<double> times;
  for (const Filter& filter : system.filters) {
    const auto* collision = std::get_if<ObjectCollision>(&filter);
    if (!collision) continue;
    for (const Object& object : collision->objects)
      for (const double time :
           std::visit([](const auto& body) { return jumps_of(body); }, object.body))
        if (time > start && std::isfinite(time)) times.push_back(time);
  }
  return times;
}

std::vector<double> sticking_event_times(const System& system, double start) {
  std::vector<double> times;
  for (const Force& force : system.forces) {
    const auto* sticking = std::get_if<Sticking>(&force);
    if (!sticking) continue;
    for (const StickyPatch& patch : sticking->patches)
      for (const double time : {patch.from, patch.until - patch.release, patch.until})
        if (time > start && std::isfinite(time)) times.push_back(time);
  }
  return times;
}

Events::Events(const System& system, double start, double tolerance)
    : given_(system),
      times_(event_times(system.prescribed, start)),
      tolerance_(tolerance),
      last_(start) {
  if (!times_.empty()) {
    own_ = std::make_unique<System>(system);
    set_prescribed_motion(start);
  }
  for (const std::vector<double>& more :
       {object_event_times(system, start), sticking_event_times(system, start)})
    times_.insert(times_.end(), more.begin(), more.end());
  std::ranges::sort(times_);
}

Events::Events(const System& system, double start, double tolerance, double last)
    : Events(system, start, tolerance) {
  if (last > start) pass(last);
}

double Events::next() const {
  return times_.empty() ? std::numeric_limits<double>::infinity() : times_.front();
}

State Events::pass_events(State s) {
  pass(s.time);
  if (own_) impose(velocities_at(own_->prescribed, s.time), s.v);
  return s;
}

void Events::pass(double t) {
  last_ = t;
  std::erase_if(times_, [&](double time) { return time <= t + tolerance_; });
  if (own_) set_prescribed_motion(t);
}

void Events::set_prescribed_motion(double t) {
  std::ranges::transform(
      given_.prescribed, own_->prescribed.begin(),
      [&](const PrescribedParticle& p) { return smooth_continuation(p, t, tolerance_); });
}

}  // namespace foldproof
