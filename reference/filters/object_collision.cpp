#include "reference/filters/object_collision.h"

#include <algorithm>

namespace foldproof {

Vector3 forecast_velocity(const ObjectPoint& at, const Vector3& v_p, double tau, double mu) {
  const Vector3 relative = v_p - at.velocity;
  const double phi_new = at.phi + tau * relative.dot(at.normal);
  if (phi_new >= 0) return v_p;

  const double push = -phi_new / tau;  // v_pN' - v_pN [m/s]
  const Vector3 sliding = relative - relative.dot(at.normal) * at.normal;
  const double speed = sliding.norm();
  const double kept = speed > 0 ? std::max(0.0, 1 - mu * push / speed) : 0;
  return at.velocity - at.phi / tau * at.normal + kept * sliding;
}

void ObjectCollision::correct(const Span& span, const State& s, PerParticle3& v, Work& work) const {
  const double tau = forecast_time > 0 ? forecast_time : span.step;
  for (int i : particles) {
    const Nearest nearest = nearest_objects(objects, s.x.col(i), span);
    ++work.object_queries;
    if (nearest.first.part >= 0)
      v.col(i) = forecast_velocity(nearest.first, v.col(i), tau, objects[nearest.first.part].friction);
  }
}

}  // namespace foldproof
