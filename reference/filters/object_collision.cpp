#include "reference/filters/object_collision.h"

#include <algorithm>

#include "reference/fast/out_of_reach.h"

namespace foldproof {

void ObjectCollision::correct(const Span& span, const State& s, PerParticle3& v, Work& work) const {
  const double tau = forecast_time > 0 ? forecast_time : span.step;
  const bool moves = span.end > span.start;
  const bool ahead = response.query_time == QueryTime::at_end;
  ObjectsOverSpan around(objects, ahead ? Span{span.end, span.end, span.step} : span);
  for (const CollisionPoint& point : points) {
    const Vector3 p = point.mean(s.x), before = point.mean(v);
    const Vector3 place = ahead ? Vector3(p + (span.end - span.start) * before) : p;
    if (out_of_reach(around, place, before, std::max(tau, span.step))) continue;
    const Vector3 after = response.velocity(around.at(place), {p, before, span, tau});
    ++work.object_queries;
    if (after == before) continue;
    if (moves) ++work.object_contacts;
    if (point.count == 1) {
      v.col(point.particles[0]) = after;
      continue;
    }
    for (int k = 0; k < point.count; ++k)
      v.col(point.particles[size_t(k)]) += point.shares[k] * (after - before);
  }
}

}  // namespace foldproof
