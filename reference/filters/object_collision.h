// Cloth against objects, point by point (BMF03 section 5.2).
#pragma once

#include <vector>

#include "reference/filters/collision_points.h"
#include "reference/filters/object_response.h"
#include "reference/level_set/object.h"
#include "reference/types.h"

namespace foldproof {

/// The filter: the response treats one point at a time, in the order of the points.
struct ObjectCollision {
  std::vector<Object> objects;
  std::vector<CollisionPoint> points;
  Response response = responses().front();
  double forecast_time = 0;  // tau [s]; 0: the step
  int threads = 1;

  /// Points that share particles are corrected one after the other, on one thread.
  void use_threads(int count, Eigen::Index particles);

  void correct(const Span& span, const State& s, PerParticle3& v, Work& work) const;
};

}  // namespace foldproof
