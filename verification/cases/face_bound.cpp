#include "verification/cases/face_bound.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace foldproof {

namespace {

constexpr double usual_stretch = 0.25;  // of a triangle, without strain limits [1]

// A body that is a union of balls of radius R about its core, corners at most d deep:
//
//   every corner c_i is at least R - d from each point q of the core. A point p = sum w_i c_i of
//   the triangle, weights w_i, has   sum w_i |c_i - q|^2 = |p - q|^2 + sum w_i |c_i - p|^2,
//   and the last sum is at most r^2. So |p - q|^2 >= (R - d)^2 - r^2.
//
// In any body p is no deeper than its nearest corner and the way there: d + r.
double depth_between(double R, double d, double r) {
  const double squared = (R - d) * (R - d) - r * r;
  return R > d && squared > 0 ? std::min(d + r, R - std::sqrt(squared)) : d + r;
}

/// Of one body [m].
double depth_in_body(const Body& body, double d, double r) {
  const auto* rigid = std::get_if<RigidObject>(&body);
  if (!rigid) return d + r;
  if (std::holds_alternative<HalfSpace>(rigid->solid)) return d;
  if (const auto* sphere = std::get_if<Sphere>(&rigid->solid))
    return depth_between(sphere->radius, d, r);
  if (const auto* capsule = std::get_if<Capsule>(&rigid->solid))
    return depth_between(capsule->radius, d, r);
  if (const auto* torus = std::get_if<Torus>(&rigid->solid))
    return depth_between(torus->tube_radius, d, r);
  return d + r;
}

}  // namespace

double enclosing_radius(const Vector3& a, const Vector3& b, const Vector3& c) {
  std::array<double, 3> squared = {(b - a).squaredNorm(), (c - b).squaredNorm(),
                                   (a - c).squaredNorm()};
  std::ranges::sort(squared);
  if (squared[0] + squared[1] <= squared[2]) return std::sqrt(squared[2]) / 2;
  const double doubled_area = (b - a).cross(c - a).norm();
  return std::sqrt(squared[0] * squared[1] * squared[2]) / (2 * doubled_area);
}

double largest_enclosing_radius(const Scene& scene) {
  const PerParticle3& x = scene.mesh.rest;
  double largest = 0;
  for (const Triangle& t : scene.mesh.triangles)
    largest = std::max(largest, enclosing_radius(x.col(t[0]), x.col(t[1]), x.col(t[2])));
  return largest * (1 + (scene.strain_limits ? largest_extension_of(scene) : usual_stretch));
}

double usual_particle_depth(const Scene& scene) { return largest_enclosing_radius(scene) / 10; }

std::optional<Expectation> expected_faces_outside(const Scene& scene,
                                                  const std::vector<Expectation>& stated) {
  const Expectation* particles = find_expectation("stays_outside", stated);
  if (scene.objects.empty() || (!particles && find_expectation("lies_inside", stated))) return {};
  const double r = largest_enclosing_radius(scene);
  const double d = particles ? particles->bound : usual_particle_depth(scene);
  double bound = d;
  for (const SceneObject& part : scene.objects)
    bound = std::max(bound, depth_in_body(part.object.body, d, r));
  const std::string of_particles =
      particles ? fmt::format("corners are at most {:.3g} m deep, as expected of particles", d)
                : fmt::format("corners may be {:.3g} m deep, r/10", d);
  const std::string why = fmt::format(
      "{}; the largest triangle fits in a circle of r = {:.3g} m when stretched by {:.3g}. Between "
      "such corners it is as deep as the chord of a round body of radius R, R - sqrt((R - d)^2 - "
      "r^2), or d + r where the body has edges or folds, and d in a half space: the response sees "
      "only particles, so this depth shows in pictures",
      of_particles, r, scene.strain_limits ? largest_extension_of(scene) : usual_stretch);
  return Expectation{"faces_outside", bound, why};
}

}  // namespace foldproof
