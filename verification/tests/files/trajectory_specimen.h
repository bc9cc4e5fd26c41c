// A case with and without objects, and states of it, for the tests of a simulation's file.
#pragma once

#include <vector>

#include "reference/dynamics/system.h"
#include "reference/mesh/triangle_mesh.h"
#include "reference/scene/scene.h"

namespace foldproof {

using Numbers = std::vector<double>;

inline Numbers numbers_of(const PerParticle3& x) { return {x.data(), x.data() + x.size()}; }

inline PerParticle3 rising(int columns, double first) {
  PerParticle3 x(3, columns);
  for (Eigen::Index i = 0; i < x.size(); ++i) x.data()[i] = first + 1.0 / double(i + 3);
  return x;
}

inline Scene bare_scene() {
  PerParticle3 rest(3, 4);
  rest << 0, 2, 0.5, 3, 0, 0.25, 2, 2.5, 0, 0.125, 0.375, -0.5;
  Scene scene = scene_at_rest(make_triangle_mesh(rest, {{0, 1, 2}, {1, 3, 2}}), 0.4);
  scene.name = "a case";
  scene.title = "A title";
  scene.about = "About it";
  scene.integrator = "B";
  return scene;
}

inline const Eigen::Quaterniond turn = Eigen::Quaterniond(5, -3, 7, 2).normalized();

/// Moves from (1, 2, 3) to (5, -2, 9) between 0 s and 2 s, always turned alike.
inline RigidMotion drifting() {
  return make_keyframes({{0, {turn, {1, 2, 3}}}, {2, {turn, {5, -2, 9}}}});
}

/// A ball that drifts, a surface that deforms, and patches of a surface and of cloth.
inline Scene full_scene() {
  Scene scene = bare_scene();
  scene.gravity = Vector3(0.5, -9.75, 0.25);
  SceneObject ball, body;
  ball.object = {"a ball", RigidObject{Sphere{0.5}, {}, drifting()}, 0.375};
  ball.shape = "a sphere";
  ball.vertices = rising(5, 10);
  ball.triangles = {{0, 1, 2}, {1, 4, 3}, {2, 3, 4}};
  body.object = {"a body", DeformingObject{}, 0.625};
  body.shape = "a mesh";
  body.vertices = rising(3, 20);
  body.triangles = {{2, 0, 1}};
  body.animation = std::make_shared<const MeshSequence>(
      MeshSequence{{{2, 0, 1}}, {0, 2}, {rising(3, 20), rising(3, 28)}});
  scene.objects = {ball, body};
  StickyPatch of_surface, of_cloth;
  of_surface.name = "a palm";
  of_surface.triangles = {{0, 1, 2}, {2, 1, 3}};
  of_surface.place = [](double) { return rising(4, 0); };
  of_surface.particles = {3, 1, 2};
  of_cloth.name = "a seam";
  of_cloth.triangles = {{1, 3, 2}};
  of_cloth.particles = {0};
  scene.sticky = {of_surface, of_cloth};
  return scene;
}

inline System system_specimen() {
  PerParticle mass(4);
  mass << 0.25, 0.5, 0.75, 1.5;
  System system = make_system(mass);
  prescribe(system, {2, Vector3(1, 2, 3), {}});
  return system;
}

inline State state_at(double time, double first) {
  return {time, rising(4, first), rising(4, -first)};
}

}  // namespace foldproof
