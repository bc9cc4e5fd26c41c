#include "reference/bodies/body_deformation.h"

#include <cmath>
#include <utility>

namespace foldproof {

namespace {

/// An arc of the length s H that turns by phi has the chord s H sin(phi/2)/(phi/2),
/// inclined by phi/2.
Vector3 bend_point(const Vector3& X, double angle, double height) {
  const double phi = angle * X.y() / height, half = phi / 2;
  const double chord = half == 0 ? X.y() : X.y() * std::sin(half) / half;
  return {chord * std::sin(half) + X.x() * std::cos(phi),
          chord * std::cos(half) - X.x() * std::sin(phi), X.z()};
}

Vector3 twist_point(const Vector3& X, double angle, double height) {
  const double phi = angle * X.y() / height, c = std::cos(phi), s = std::sin(phi);
  return {c * X.x() + s * X.z(), X.y(), c * X.z() - s * X.x()};
}

/// A parabola in the height: `growth` half way up, 0 at both ends.
Vector3 breathe_point(const Vector3& X, double growth, double height) {
  const double s = X.y() / height, factor = 1 + growth * 4 * s * (1 - s);
  return {factor * X.x(), X.y(), factor * X.z()};
}

Vector3 deform_point(const BodyDeformation& part, const Vector3& X, double height, double t) {
  const double amount = part.amplitude * (1 - std::cos(2 * pi * t / part.period)) / 2;
  switch (part.kind) {
    case DeformationKind::bend:
      return bend_point(X, amount, height);
    case DeformationKind::twist:
      return twist_point(X, amount, height);
    case DeformationKind::breathe:
      return breathe_point(X, amount, height);
  }
  throw InputError("deformation: there is no such kind");
}

}  // namespace

Deformation deformation_of(std::vector<BodyDeformation> parts, const Bounds& bounds) {
  const Vector3 middle = bounds.center(), base(middle.x(), bounds.min().y(), middle.z());
  const double height = bounds.sizes().y();
  return [parts = std::move(parts), base, height](const Vector3& X, double t) -> Vector3 {
    Vector3 x = X - base;
    for (const BodyDeformation& part : parts) x = deform_point(part, x, height, t);
    return x + base;
  };
}

}  // namespace foldproof
