// For speed alone: points that provably keep clear of all objects are not queried.
#pragma once

#include "reference/level_set/object.h"

namespace foldproof {

/// True if the last answers of `objects` prove that a point at p [m] with velocity v [m/s] cannot
/// reach any object within `time` [s]; the collision response would leave it as it is.
bool out_of_reach(const ObjectsOverSpan& objects, const Vector3& p, const Vector3& v, double time);

}  // namespace foldproof
