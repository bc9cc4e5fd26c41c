#include "reference/fast/out_of_reach.h"

#include <algorithm>
#include <cmath>

namespace foldproof {

namespace {

// Bound on |grad phi|. An exact distance has 1. Each slope of its trilinear interpolant along an
// axis is a mean of differences along cell edges, at most 1, so the gradient is at most sqrt(3).
// Nodes with an error e (hanging, or from marching) add 2 e/width to a slope: 2 is enough for e =
// 0.077 widths.
constexpr double steepest = 2;

}  // namespace

RememberedQuery::RememberedQuery(std::span<const Object> objects, const Span& span)
    : objects_(objects, span), phi_(objects.size(), std::numeric_limits<double>::infinity()) {
  for (const Object& object : objects) {
    const auto* rigid = std::get_if<RigidObject>(&object.body);
    rigid_.push_back(rigid ? std::optional(rigid->over(span)) : std::nullopt);
  }
}

std::span<ObjectPoint> RememberedQuery::at(const Vector3& p) {
  const std::span<ObjectPoint> answers = objects_.at(p);
  std::ranges::transform(answers, phi_.begin(), &ObjectPoint::phi);
  point_ = p;
  return answers;
}

bool RememberedQuery::out_of_reach(const Vector3& p, const Vector3& v, double time) const {
  const double moved = steepest * (p - point_).norm();
  for (std::size_t i = 0; i < phi_.size(); ++i) {
    const double clearance = phi_[i] - moved;  // lower bound [m]
    if (!(clearance > 0) || std::isinf(clearance) || !rigid_[i]) return false;
    const double squared_speed = (v - rigid_[i]->velocity_at(p)).squaredNorm();
    if (!(clearance * clearance > time * time * squared_speed)) return false;
  }
  return true;
}

}  // namespace foldproof
