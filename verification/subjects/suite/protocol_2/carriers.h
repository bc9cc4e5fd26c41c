// The small sheet on a level obstacle of each kind, which may move.
#pragma once

#include <array>

#include "verification/subjects/suite/laws.h"

namespace foldproof::suite {

/// An obstacle whose top is at z = 0 under the sheet.
struct Carrier {
  const char* capability;
  void (*put)(PortableScene&, double friction, const PortableMotion&);

  /// The motion of one that stands still; frames of what deforms need times.
  PortableMotion standing() const;
};

const std::array<Carrier, 6>& carriers();

/// The sheet lies on z = 0 about the origin; gravity is that of the earth.
PortableScene sheet_on_top(const char* name);

/// At constant velocity until a time [m/s], [s].
PortableMotion straight(const Vector3& velocity, double end);

/// Throws NotOffered if the solver has none of them.
template <class Ask>
void for_each_carrier(Trial& trial, Ask ask) {
  int asked = 0;
  for (const Carrier& carrier : carriers())
    if (trial.declaration().offers(carrier.capability)) ask(carrier), ++asked;
  if (asked == 0) throw NotOffered{"an obstacle"};
}

}  // namespace foldproof::suite
