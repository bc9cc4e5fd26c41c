#include "reference/scene/scene.h"

#include <algorithm>
#include <cmath>

#include "reference/mesh/self_intersection.h"
#include "reference/scene/field_recipe.h"

namespace foldproof {

Scene scene_at_rest(TriangleMesh mesh, double density) {
  Scene scene;
  scene.x = mesh.rest;
  scene.v = PerParticle3::Zero(3, mesh.rest.cols());
  scene.mesh = std::move(mesh);
  scene.density = density;
  return scene;
}

namespace {

/// The mean of the point's particles that have a coefficient of their own [1]; NaN: none has.
double friction_at(const CollisionPoint& point, const PerParticle& friction) {
  double sum = 0, count = 0;
  for (int k = 0; k < point.count; ++k) {
    const double own = friction[point.particles[size_t(k)]];
    if (!std::isnan(own)) sum += own, ++count;
  }
  return sum / count;
}

ObjectCollision object_collision(const Scene& scene, const System& system,
                                 std::vector<Object> objects) {
  ObjectCollision filter;
  filter.objects = std::move(objects);
  filter.points = collision_points(scene.mesh, system.inverse_mass, scene.collision.points);
  const PerParticle friction = friction_of(scene);
  if (friction.size() > 0)
    for (CollisionPoint& point : filter.points) point.friction = friction_at(point, friction);
  filter.response = response_named(scene.collision.response);
  filter.forecast_time = scene.collision.forecast_time;
  return filter;
}

SelfCollision self_collision(const Scene& scene, const System& system, const State& start) {
  CrossingTriangles at_start;
  if (scene.self_collision->untangle)  // else the reader rejects a start that crosses itself
    at_start = self_intersections(start.x, scene.mesh.triangles);
  return {*scene.self_collision,
          make_cloth_tree(scene.mesh),
          system.mass,
          system.inverse_mass,
          at_start,
          layers_of(scene)};
}

StrainLimiter strain_limiter(const Scene& scene, const System& system) {
  for (const Force& force : system.forces)
    if (const auto* stretch = std::get_if<StretchSprings>(&force))
      return make_strain_limiter(*scene.strain_limits, stretch->springs, system.inverse_mass,
                                 strain_ranges_of(scene));
  throw InputError("strain limits limit springs; the scene has none");
}

}  // namespace

std::vector<Object> build_objects(const Scene& scene, const LevelSetProvider& level_sets) {
  std::vector<Object> objects;
  for (const SceneObject& part : scene.objects) {
    objects.push_back(part.object);
    if (part.field) make_field(*part.field, level_sets, objects.back().body);
  }
  return objects;
}

BuiltScene build(const Scene& scene, const LevelSetProvider& level_sets) {
  std::vector<Object> objects = build_objects(scene, level_sets);
  System system = make_system(masses_of(scene));
  if (scene.gravity) system.forces.push_back(Gravity{*scene.gravity, system.mass});
  if (scene.stretch) system.forces.push_back(springs_of(scene));
  if (scene.membrane) system.forces.push_back(membrane_of(scene));
  if (scene.bending)
    for (Bending& bending : bending_of(scene)) system.forces.push_back(std::move(bending));
  if (scene.air) system.forces.push_back(make_air(scene.mesh.triangles, *scene.air));
  if (!scene.sticky.empty()) system.forces.push_back(Sticking{scene.sticky});
  for (const PrescribedParticle& particle : scene.prescribed) prescribe(system, particle);
  State start = start_state(scene);
  if (scene.strain_limits) system.filters.push_back(strain_limiter(scene, system));
  if (!scene.objects.empty()) system.filters.push_back(object_collision(scene, system, objects));
  if (scene.self_collision) system.filters.push_back(self_collision(scene, system, start));
  system.solver = scene.solver;
  return {std::move(system), std::move(start), std::move(objects)};
}

System build_system(const Scene& scene) { return build(scene, computing_provider()).system; }

PerParticle3 surface_at(const SceneObject& part, double t) {
  if (part.animation) return positions_at(*part.animation, t);
  const Pose pose = pose_at(std::get<RigidObject>(part.object.body).motion, t);
  PerParticle3 x(3, part.vertices.cols());
  for (Eigen::Index i = 0; i < x.cols(); ++i) x.col(i) = to_world(pose, part.vertices.col(i));
  return x;
}

PerParticle3 surface_velocity_at(const SceneObject& part, double t) {
  PerParticle3 v = PerParticle3::Zero(3, part.vertices.cols());
  if (part.animation) {
    const std::vector<double>& times = part.animation->times;
    const auto next = size_t(std::ranges::upper_bound(times, t) - times.begin());
    if (next == 0 || next == times.size()) return v;
    const std::vector<PerParticle3>& x = part.animation->positions;
    return (x[next] - x[next - 1]) / (times[next] - times[next - 1]);
  }
  const PerParticle3 x = surface_at(part, t);
  const RigidMotion& motion = std::get<RigidObject>(part.object.body).motion;
  for (Eigen::Index i = 0; i < v.cols(); ++i) v.col(i) = velocity_at(motion, x.col(i), t);
  return v;
}

State start_state(const Scene& scene) {
  State s{0, scene.x, scene.v};
  for (const PrescribedParticle& p : scene.prescribed) {
    s.x.col(p.particle) = position_at(p.motion, p.start, 0);
    s.v.col(p.particle) = velocity_at(p.motion, p.start, 0);
  }
  return s;
}

}  // namespace foldproof
