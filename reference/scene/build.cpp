#include "reference/scene/scene.h"

#include <algorithm>
#include <cstdio>
#include <set>

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

ObjectCollision object_collision(const Scene& scene, const System& system,
                                 std::vector<Object> objects) {
  ObjectCollision filter;
  filter.objects = std::move(objects);
  filter.points = collision_points(scene.mesh, system.inverse_mass, scene.collision.points);
  filter.response = response_named(scene.collision.response);
  filter.forecast_time = scene.collision.forecast_time;
  return filter;
}

SelfCollision self_collision(const Scene& scene, const System& system) {
  return {*scene.self_collision, make_cloth_tree(scene.mesh), system.mass, system.inverse_mass,
          self_intersections(start_state(scene).x, scene.mesh.triangles)};
}

StrainLimiter strain_limiter(const Scene& scene, const PerParticle& inverse_mass) {
  if (!scene.stretch) throw InputError("strain limits limit springs; the scene has none");
  return make_strain_limiter(*scene.strain_limits, make_springs(scene.mesh, *scene.stretch).springs,
                             inverse_mass);
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
  System system = make_system(lumped_masses(scene.mesh, scene.density));
  if (scene.gravity) system.forces.push_back(Gravity{*scene.gravity, system.mass});
  if (scene.stretch) system.forces.push_back(make_springs(scene.mesh, *scene.stretch));
  if (scene.bending)
    system.forces.push_back(make_bending(scene.mesh, *scene.bending, scene.rest_angles));
  if (!scene.sticky.empty()) system.forces.push_back(Sticking{scene.sticky});
  for (const PrescribedParticle& particle : scene.prescribed) prescribe(system, particle);
  if (scene.strain_limits) system.filters.push_back(strain_limiter(scene, system.inverse_mass));
  if (!scene.objects.empty()) system.filters.push_back(object_collision(scene, system, objects));
  if (scene.self_collision) system.filters.push_back(self_collision(scene, system));
  system.solver = scene.solver;
  return {std::move(system), start_state(scene), std::move(objects)};
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

namespace {

std::string describe(const BendingMaterial& material) {
  return std::string(material.weighting == Weighting::rest ? "rest" : "current") +
         " weighting, law '" + std::string(material.law) + "'" +
         (material.damping > 0 ? ", damped" : "");
}

std::string describe(const SceneObject& part) {
  char friction[40];
  std::snprintf(friction, sizeof friction, "%.6g", part.object.friction);
  const std::string frames =
      part.animation ? ", " + std::to_string(part.animation->times.size()) + " level sets" : "";
  return "object '" + part.object.name + "' (" + part.shape + frames + ", friction " + friction +
         ")";
}

std::string describe(const StickyPatch& patch) {
  return "sticky '" + patch.name + "' (" + std::to_string(patch.triangles.size()) +
         " triangles of " + (patch.place ? "an object" : "the cloth") + ", " +
         std::to_string(patch.particles.size()) + " particles that may stick)";
}

std::string describe(const StrainLimiter& limiter) {
  const StrainLimits& limits = limiter.limits;
  char range[80];
  std::snprintf(range, sizeof range, "%.6g to %.6g", 1 - limits.compression, 1 + limits.extension);
  const std::string colours = limits.order == SweepOrder::coloured
                                  ? " in " + std::to_string(limiter.colours.size() - 1) + " colours"
                                  : "";
  return std::to_string(limiter.springs.size()) + " springs" + colours + " limited to " + range +
         " of their rest lengths, in at most " + std::to_string(limits.sweeps) + " sweeps";
}

std::string describe(const ObjectCollision& collision) {
  return std::to_string(collision.points.size()) + " points held out of objects, response '" +
         std::string(collision.response.name) + "'";
}

std::string describe(const SelfCollision& self) {
  char numbers[80];
  std::snprintf(numbers, sizeof numbers, "self-collision (thickness %.6g m, friction %.6g)",
                self.settings.thickness, self.settings.friction);
  return numbers + (self.at_start.empty()
                        ? ""
                        : ", which starts crossing itself: " + list_triangles(self.at_start));
}

/// "1 hinge", "5 hinges".
std::string count_text(size_t count, const std::string& what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

/// "2 vertices split into 5 particles".
std::string described_split(const std::vector<int>& copy_of) {
  std::set<int> split;
  size_t copies = 0;
  for (int i = 0; i < int(copy_of.size()); ++i) {
    if (copy_of[size_t(i)] == i) continue;
    split.insert(copy_of[size_t(i)]);
    ++copies;
  }
  return std::to_string(split.size()) + (split.size() == 1 ? " vertex" : " vertices") +
         " split into " + std::to_string(split.size() + copies) + " particles";
}

}  // namespace

std::vector<std::string> describe_parts(const Scene& scene, const System& system) {
  std::vector<std::string> parts = {count_text(size_t(scene.mesh.particles()), "particle") + ", " +
                                    count_text(scene.mesh.triangles.size(), "triangle")};
  if (!scene.copy_of.empty()) parts.push_back(described_split(scene.copy_of));
  for (const Force& force : system.forces) {
    if (std::holds_alternative<Gravity>(force)) parts.push_back("gravity");
    if (const auto* springs = std::get_if<StretchSprings>(&force))
      parts.push_back(count_text(springs->springs.size(), "spring") +
                      (scene.stretch->damping > 0 ? ", damped" : ""));
    if (const auto* bending = std::get_if<Bending>(&force))
      parts.push_back(count_text(bending->hinges.size(), "hinge") + ", " +
                      describe(bending->material));
  }
  if (!system.prescribed.empty())
    parts.push_back(count_text(system.prescribed.size(), "particle") + " with prescribed motion");
  for (const SceneObject& part : scene.objects) parts.push_back(describe(part));
  for (const StickyPatch& patch : scene.sticky) parts.push_back(describe(patch));
  for (const Filter& filter : system.filters)
    if (const auto* limiter = std::get_if<StrainLimiter>(&filter))
      parts.push_back(describe(*limiter));
  for (const Filter& filter : system.filters)
    if (const auto* collision = std::get_if<ObjectCollision>(&filter))
      parts.push_back(describe(*collision));
  for (const Filter& filter : system.filters)
    if (const auto* self = std::get_if<SelfCollision>(&filter)) parts.push_back(describe(*self));
  return parts;
}

}  // namespace foldproof
