#include "reference/level_set/signed_distance.h"

#include <algorithm>
#include <cmath>

namespace foldproof {

namespace {

/// A unit vector along d; `fallback` where d is zero.
Vector3 direction_of(const Vector3& d, const Vector3& fallback) {
  const double length = d.norm();
  return length > 0 ? Vector3(d / length) : fallback;
}

/// The distance to all points within `radius` of a core whose point nearest to p is `nearest`;
/// `fallback` is N on the core itself.
Distance round_off(const Vector3& p, const Vector3& nearest, double radius,
                   const Vector3& fallback) {
  const Vector3 away = p - nearest;
  return {away.norm() - radius, direction_of(away, fallback)};
}

}  // namespace

Distance HalfSpace::at(const Vector3& p) const { return {p.z(), Vector3::UnitZ()}; }

Distance Sphere::at(const Vector3& p) const {
  return round_off(p, Vector3::Zero(), radius, Vector3::UnitZ());
}

Distance Box::at(const Vector3& p) const {
  const Vector3 beyond = p.cwiseAbs() - half_extents;  // per axis, positive outside the two faces
  const Vector3 side(std::copysign(1, p.x()), std::copysign(1, p.y()), std::copysign(1, p.z()));
  if (beyond.maxCoeff() <= 0) {  // inside: the nearest face
    Eigen::Index axis;
    const double phi = beyond.maxCoeff(&axis);
    return {phi, side[axis] * Vector3::Unit(axis)};
  }
  const Vector3 out = beyond.cwiseMax(0);
  return {out.norm(), side.cwiseProduct(out) / out.norm()};
}

Distance Capsule::at(const Vector3& p) const {
  return round_off(p, {0, 0, std::clamp(p.z(), -half_length, half_length)}, radius,
                   Vector3::UnitX());
}

Distance Torus::at(const Vector3& p) const {
  const Vector3 outward = direction_of({p.x(), p.y(), 0}, Vector3::UnitX());
  return round_off(p, ring_radius * outward, tube_radius, outward);
}

}  // namespace foldproof
