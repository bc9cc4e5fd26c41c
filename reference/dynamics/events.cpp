#include "reference/dynamics/events.h"

#include <algorithm>
#include <limits>

namespace foldproof {

Events::Events(const System& system, double start, double tolerance)
    : given_(system), times_(event_times(system.led, start)), tolerance_(tolerance) {
  if (times_.empty()) return;
  own_ = std::make_unique<System>(system);
  lead(start);
}

double Events::next() const {
  return times_.empty() ? std::numeric_limits<double>::infinity() : times_.front();
}

State Events::passed(State s) {
  std::erase_if(times_, [&](double time) { return time <= s.time + tolerance_; });
  lead(s.time);
  impose(velocities_at(own_->led, s.time), s.v);
  return s;
}

void Events::lead(double t) {
  std::ranges::transform(given_.led, own_->led.begin(),
                         [&](const PrescribedParticle& p) { return as_after(p, t, tolerance_); });
}

}  // namespace foldproof
