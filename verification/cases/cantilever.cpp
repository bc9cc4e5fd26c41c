#include "verification/cases/cantilever.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "reference/mesh/rigidity_map.h"
#include "verification/oracles/elastica.h"

namespace foldproof {

namespace {

/// The mean place of the particles whose rest lies between two marks along a direction.
Vector3 middle_of(const PerParticle3& x, const PerParticle& along, double from, double to) {
  Vector3 sum = Vector3::Zero();
  int count = 0;
  for (Eigen::Index i = 0; i < x.cols(); ++i)
    if (along[i] >= from && along[i] <= to) {
      sum += x.col(i);
      ++count;
    }
  return sum / count;
}

/// The two rows that are held, as places along the strip from its held end [m]; or nothing.
std::optional<std::array<double, 2>> held_rows(const Scene& scene, const PerParticle& along) {
  const double close = 1e-9 * along.maxCoeff();
  std::set<int> held;
  double last = 0;
  for (const PrescribedParticle& one : scene.prescribed) {
    if (!velocity_at(one.motion, one.start, 0).isZero(0)) return {};
    held.insert(one.particle);
    last = std::max(last, along[one.particle]);
  }
  double between = 0;  // the row before it
  for (Eigen::Index i = 0; i < along.size(); ++i) {
    if ((along[i] <= last + close) != held.contains(int(i))) return {};
    if (along[i] > close && along[i] < last - close) between = along[i];
  }
  if (!(last > close) || between > 0 || !(last < along.maxCoeff() - close)) return {};
  return std::array{0.0, last};
}

}  // namespace

std::optional<ClampedStrip> clamped_strip(const Scene& scene, const PerParticle3& x) {
  RestPlane plane;
  if (!scene.gravity || !(scene.gravity->norm() > 0) || !scene.bending || !scene.objects.empty() ||
      !is_flat(scene.mesh, plane))
    return {};
  for (const double sign : {1.0, -1.0})
    for (const int axis : {0, 1}) {
      PerParticle along =
          sign * (scene.mesh.rest.transpose() * (axis == 0 ? plane.first : plane.second));
      along.array() -= along.minCoeff();
      const auto rows = held_rows(scene, along);
      if (!rows) continue;
      const double close = 1e-9 * along.maxCoeff(), end = along.maxCoeff(), last = (*rows)[1];
      const Vector3 first = middle_of(x, along, -close, close),
                    second = middle_of(x, along, last - close, last + close),
                    tip = middle_of(x, along, end - close, end + close);
      const Vector3 up = -scene.gravity->normalized(), out = (second - first).normalized();
      const double slope = std::asin(std::clamp(out.dot(up), -1.0, 1.0));
      const Vector3 level = (out - out.dot(up) * up).normalized();
      if (!level.allFinite() || !(std::abs(slope) < std::numbers::pi / 2 - 1e-3)) return {};
      ClampedStrip strip{};
      strip.length = end - last / 2;
      strip.rigidity = scene.bending->stiffness *
                       rigidity_of(scene.mesh, plane).of_strip(axis * std::numbers::pi / 2);
      strip.gamma =
          scene.density * scene.gravity->norm() * std::pow(strip.length, 3) / strip.rigidity;
      if (!(strip.gamma > 0 && strip.gamma < 1e5)) return {};
      const Vector3 from = tip - (first + second) / 2;
      strip.drop = -from.dot(up);
      strip.reach = from.dot(level);
      const std::array ends{1.0};
      const oracles::StripShape shape =
          oracles::strip_by_collocation({strip.gamma, slope, {}}, ends);
      strip.elastica_drop = -shape.points[0].up * strip.length;
      strip.elastica_reach = shape.points[0].across * strip.length;
      return strip;
    }
  return {};
}

}  // namespace foldproof
