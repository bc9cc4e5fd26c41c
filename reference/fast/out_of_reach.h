// For speed only: points that provably stay clear of all objects are not queried.
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "reference/level_set/object.h"

namespace foldproof {

/// Objects during a span, with the answers to the latest query. The objects must outlive it.
class RememberedQuery {
 public:
  RememberedQuery(std::span<const Object> objects, const Span& span);

  /// As ObjectsOverSpan::at.
  std::span<ObjectPoint> at(const Vector3& p);

  /// True if the latest answers prove that a point at p [m] with velocity v [m/s] cannot reach any
  /// object within `time` [s]; the collision response would leave it as it is.
  bool out_of_reach(const Vector3& p, const Vector3& v, double time) const;

 private:
  ObjectsOverSpan objects_;
  std::vector<std::optional<RigidOverSpan>> rigid_;  // of each object; empty if it deforms
  std::vector<double> phi_;          // m, of each object in the latest answers; infinite before any
  Vector3 point_ = Vector3::Zero();  // m, of the latest query
};

}  // namespace foldproof
