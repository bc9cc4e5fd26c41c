#include "reference/filters/object_collision.h"

namespace foldproof {

void ObjectCollision::correct(const Span& span, const State& s, PerParticle3& v, Work& work) const {
  const double tau = forecast_time > 0 ? forecast_time : span.step;
  const bool moves = span.end > span.start;
  for (const CollisionPoint& point : points) {
    const Vector3 before = point.mean(v);
    const Vector3 after = response.velocity(objects, {point.mean(s.x), before, span, tau});
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
