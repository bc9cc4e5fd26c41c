#include "convergence/any_case/ablation.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace foldproof {

namespace {

using Parts = std::vector<ScenePart>;

void add(Parts& parts, bool applies, bool is_present, const std::string& name,
         std::function<void(Scene&)> toggle) {
  if (!applies) return;
  parts.push_back({name, is_present, [toggle = std::move(toggle)](Scene scene) {
                     toggle(scene);
                     return scene;
                   }});
}

void add_present(Parts& parts, bool applies, const std::string& name,
                 std::function<void(Scene&)> remove) {
  add(parts, applies, true, name, std::move(remove));
}

void add_absent(Parts& parts, bool applies, const std::string& name,
                std::function<void(Scene&)> put) {
  add(parts, applies, false, name, std::move(put));
}

void add_forces(const Scene& scene, Parts& parts) {
  add_present(parts, scene.gravity && scene.gravity->norm() > 0, "gravity",
              [](Scene& s) { s.gravity.reset(); });
  add_present(parts, scene.stretch.has_value(), "springs", [](Scene& s) {
    s.stretch.reset();
    s.strain_limits.reset();
  });
  add_present(parts, scene.stretch && scene.stretch->damping > 0, "damping of springs",
              [](Scene& s) { s.stretch->damping = 0; });
  add_present(parts, scene.bending.has_value(), "bending", [](Scene& s) {
    s.bending.reset();
    s.rest_angles.clear();
  });
  add_present(parts, scene.bending && scene.bending->damping > 0, "damping of bending",
              [](Scene& s) { s.bending->damping = 0; });
  constexpr double flat = 1e-9;  // rad: what rounding makes of a flat sheet
  const bool is_shaped =
      std::ranges::any_of(scene.rest_angles, [](double angle) { return std::abs(angle) > flat; });
  add_present(parts, is_shaped, "rest angles",
              [](Scene& s) { std::ranges::fill(s.rest_angles, 0.0); });
}

void add_objects(const Scene& scene, Parts& parts) {
  for (size_t k = 0; k < scene.objects.size(); ++k)
    add_present(parts, true, "object '" + scene.objects[k].object.name + "'",
                [k](Scene& s) { s.objects.erase(s.objects.begin() + std::ptrdiff_t(k)); });
  const bool rubs = std::ranges::any_of(
      scene.objects, [](const SceneObject& part) { return part.object.friction > 0; });
  add_present(parts, rubs, "friction of objects", [](Scene& s) {
    for (SceneObject& part : s.objects) part.object.friction = 0;
  });
  add_present(parts, !scene.objects.empty() && scene.collision.points != PointKind::particles,
              "points between particles",
              [](Scene& s) { s.collision.points = PointKind::particles; });
  add_absent(parts, !scene.objects.empty() && scene.collision.points == PointKind::particles,
             "points between particles", [](Scene& s) { s.collision.points = PointKind::faces; });
}

void add_constraints(const Scene& scene, Parts& parts) {
  add_present(parts, !scene.prescribed.empty(), "held particles",
              [](Scene& s) { s.prescribed.clear(); });
  for (size_t k = 0; k < scene.sticky.size(); ++k)
    add_present(parts, true, "sticky '" + scene.sticky[k].name + "'",
                [k](Scene& s) { s.sticky.erase(s.sticky.begin() + std::ptrdiff_t(k)); });
  add_present(parts, scene.strain_limits.has_value(), "strain limits",
              [](Scene& s) { s.strain_limits.reset(); });
  add_absent(parts, scene.stretch && !scene.strain_limits, "strain limits",
             [](Scene& s) { s.strain_limits = StrainLimits{}; });
  add_present(parts, scene.self_collision.has_value(), "self-collision",
              [](Scene& s) { s.self_collision.reset(); });
  add_absent(parts, !scene.self_collision, "self-collision", [](Scene& s) {
    s.self_collision = SelfCollisionSettings{};
    s.self_collision->thickness = smallest_height(s.mesh.triangles, s.mesh.rest) / 4;
  });
}

}  // namespace

std::vector<ScenePart> parts_of(const Scene& scene) {
  Parts parts;
  add_forces(scene, parts);
  add_objects(scene, parts);
  add_constraints(scene, parts);
  return parts;
}

}  // namespace foldproof
