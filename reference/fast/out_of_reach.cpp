#include "reference/fast/out_of_reach.h"

#include <cmath>

namespace foldproof {

namespace {

// phi changes by no more than this per distance: a distance by 1. Each slope of its trilinear
// interpolant along an axis is a mean of differences along edges of the cell, at most 1, so that
// all three make sqrt(3) at most. Nodes that miss the distance by e (they hang, or marching missed)
// add 2 e/width to a slope: 2 is enough for e = 0.077 widths.
constexpr double steepest = 2;

}  // namespace

bool out_of_reach(const ObjectsOverSpan& objects, const Vector3& p, const Vector3& v, double time) {
  const double moved = steepest * (p - objects.queried_point()).norm();  // NaN before any query
  for (const ObjectPoint& answer : objects.answers()) {
    const double clearance = answer.phi - moved;  // m, at least
    if (!(clearance > 0) || std::isinf(clearance)) return false;
    const double squared_speed = objects.squared_relative_speed(answer.part, p, v);
    if (!(clearance * clearance > time * time * squared_speed)) return false;
  }
  return true;
}

}  // namespace foldproof
