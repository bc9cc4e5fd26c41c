// Cloth against objects, point by point (BMF03 section 5.2).
#pragma once

#include <vector>

#include "reference/fast/team.h"
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
  Team team = {};

  /// Points with common particles are corrected one after the other.
  void set_team(const Team& of, Eigen::Index particles);

  void correct(const Span& span, const State& s, PerParticle3& v, Work& work) const;
};

}  // namespace foldproof
