// What a case says, read and checked, before anything is built of it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "reference/dynamics/simulate.h"
#include "reference/filters/object_collision.h"
#include "reference/forces/force.h"
#include "reference/mesh/triangle_mesh.h"
#include "reference/motion/motion.h"
#include "reference/types.h"

namespace foldproof {

/// An object, and its surface as triangles: for pictures, not for the collisions.
struct SceneObject {
  Object object;
  std::string shape;                // in words
  PerParticle3 vertices;            // 3 x V, before its motion [m]
  std::vector<Triangle> triangles;  // outward
};

/// How cloth meets the objects.
struct CollisionSettings {
  double forecast_time = 0;  // tau [s]; 0: the step
  PointKind points = PointKind::particles;
  std::string response = "forecast";
};

/// A scene names its parts; what it does not name is absent, is not built and costs nothing.
struct Scene {
  std::string name, title, about;
  std::string text;  // the case file with its overrides, empty for scenes made by code

  TriangleMesh mesh;   // with the rest shape
  PerParticle3 x, v;   // start, 3 x N [m], [m/s]
  double density = 0;  // area density [kg/m^2]

  std::optional<Vector3> gravity;  // m/s^2
  std::optional<StretchMaterial> stretch;
  std::optional<BendingMaterial> bending;
  std::vector<double> rest_angles;  // one a hinge [rad], when there is bending
  std::vector<PrescribedParticle> led;
  std::vector<SceneObject> objects;
  CollisionSettings collision;

  std::string integrator = "C";
  Schedule schedule;
  SolverSettings solver;
};

/// A scene of the mesh at rest in its rest shape, without any force.
Scene scene_of(TriangleMesh mesh, double density);

/// Reads a case file. Throws InputError "file:line: ..." for anything that it does not understand; see
/// cases/README.md for the keys.
///   overrides   "a.b=c", applied in order
Scene read_scene(const std::string& path, const std::vector<std::string>& overrides = {});

/// The same from text; `path` names it in messages, and relative mesh files are looked for beside it.
Scene read_scene_text(const std::string& text, const std::string& path,
                      const std::vector<std::string>& overrides = {});

/// Builds what the scene names, and nothing else.
System build_system(const Scene& scene);

State start_state(const Scene& scene);

/// What was built, a phrase for each part: "289 particles, 512 triangles", "gravity", "800 springs", ...
std::vector<std::string> built_parts(const Scene& scene, const System& system);

}  // namespace foldproof
