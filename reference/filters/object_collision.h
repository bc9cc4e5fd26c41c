// Cloth against objects: interface forecasting with friction (BMF03 section 5.2).
#pragma once

#include <vector>

#include "reference/level_set/object.h"
#include "reference/types.h"

namespace foldproof {

/// A velocity that may be corrected, of a point with this signed distance to an object:
///   phi_new = phi + tau (v_p - v).N                     the signed distance forecast at the time tau ahead
///   v_pN'   = v_pN - phi_new/tau  if phi_new < 0        so that the point is forecast to lie on the surface
///   v_T'    = max(0, 1 - mu (v_pN' - v_pN)/|v_T|) v_T   Coulomb friction of the tangential relative velocity
/// Untouched, bit for bit, if phi_new >= 0. v_p [m/s], tau [s] > 0, mu [1].
Vector3 forecast_velocity(const ObjectPoint& at, const Vector3& v_p, double tau, double mu);

/// The filter: every free particle, point by point, against the object that it is deepest in or nearest to.
struct ObjectCollision {
  std::vector<Object> objects;
  std::vector<int> particles;  // those that it corrects: the free ones
  double forecast_time = 0;    // tau [s]; 0: the step

  void correct(const Span& span, const State& s, PerParticle3& v, Work& work) const;
};

}  // namespace foldproof
