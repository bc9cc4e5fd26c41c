// What a case says, read and checked, before anything is built of it: a recipe.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "reference/dynamics/simulate.h"
#include "reference/filters/object_collision.h"
#include "reference/filters/self_collision.h"
#include "reference/filters/strain_limit.h"
#include "reference/forces/force.h"
#include "reference/mesh/triangle_mesh.h"
#include "reference/motion/motion.h"
#include "reference/scene/scene_limits.h"
#include "reference/types.h"

namespace foldproof {

struct LevelSetProvider;  // bodies/level_set_provider.h
struct FieldRecipe;       // scene/field_recipe.h

/// An object, and its surface as triangles: for pictures, not for the collisions.
struct SceneObject {
  Object object;  // if there is a recipe of its body's field, the body lacks it until it is built
  std::shared_ptr<const FieldRecipe> field;  // of a body of triangles, else none
  std::string shape;                         // in words
  PerParticle3 vertices;  // 3 x V, before its motion, or in its first frame if it deforms [m]
  std::vector<Triangle> triangles;                // outward
  std::shared_ptr<const MeshSequence> animation;  // of a body that deforms, else none
};

/// The surface's vertices at time t [s], 3 x V [m].
PerParticle3 surface_at(const SceneObject& part, double t);

/// Their velocities, 3 x V [m/s]; where they jump the later ones.
PerParticle3 surface_velocity_at(const SceneObject& part, double t);

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
  // of the case file, where its relative files are looked for; empty for scenes made by code
  std::string folder;

  TriangleMesh mesh;   // with the rest shape
  PerParticle3 x, v;   // start, 3 x N [m], [m/s]
  double density = 0;  // area density [kg/m^2]
  // N: the particle that each is, or is a copy of where its vertex was split (mesh/split_fans.h);
  // empty where none was
  std::vector<int> copy_of = {};

  std::optional<Vector3> gravity;  // m/s^2
  std::optional<StretchMaterial> stretch;
  std::optional<BendingMaterial> bending;
  std::vector<double> rest_angles;  // one a hinge [rad], when there is bending
  std::vector<PrescribedParticle> prescribed;
  std::vector<SceneObject> objects;
  CollisionSettings collision;
  std::optional<StrainLimits> strain_limits;  // needs stretch
  std::optional<SelfCollisionSettings> self_collision;
  std::vector<StickyPatch> sticky;  // what cloth may stick to

  std::string integrator = "C";
  Schedule schedule;
  SolverSettings solver;
};

/// A scene of the mesh at rest in its rest shape, without any force.
Scene scene_at_rest(TriangleMesh mesh, double density);

/// A case file, parsed once: whoever reads a part of it asks this tree.
struct CaseKeys {
  std::string path, text;          // the file's, overrides noted at the end of the text
  std::shared_ptr<KeyTable> keys;  // with the overrides
};

/// Parses a case file. Throws InputError "file:line: ..." for what is no TOML.
///   overrides   "a.b=c", applied in order
CaseKeys parse_case(const std::string& path, const std::vector<std::string>& overrides);

/// The same of text; `path` names it in messages, and relative mesh files are looked for beside it.
CaseKeys parse_case_text(const std::string& text, const std::string& path,
                         const std::vector<std::string>& overrides);

/// The scene that the keys describe; no level set is computed. Throws InputError "file:line: ..."
/// for anything that it does not understand, but leaves keys that it does not know to reject_unused
/// of the tree, after all of it was read. See cases/KEYS.md for the keys.
Scene scene_from(const CaseKeys& of, const SceneLimits& limits = {});

/// The scene of a case file alone: its tables [expect] and [ablation] are left aside. Throws
/// InputError as above, and for any other key that nobody knows.
Scene read_scene(const std::string& path, const std::vector<std::string>& overrides = {});
Scene read_scene_text(const std::string& text, const std::string& path,
                      const std::vector<std::string>& overrides = {},
                      const SceneLimits& limits = {});

/// What moves, and where it starts.
struct BuiltScene {
  System system;
  State start;
  // with the fields of their bodies; whoever judges asks these, not the system's own
  std::vector<Object> objects;
};

/// Builds what the scene names, and nothing else. level_sets: who makes those of its bodies. Throws
/// InputError, that names the key's place where it was read from a file, for a level set that
/// cannot be made.
BuiltScene build(const Scene& scene, const LevelSetProvider& level_sets);

/// The system of build(), its level sets computed.
System build_system(const Scene& scene);

State start_state(const Scene& scene);

/// The scene's objects, with the fields of their bodies.
std::vector<Object> build_objects(const Scene& scene, const LevelSetProvider& level_sets);

/// What was built, a phrase for each part: "289 particles, 512 triangles", "gravity",
/// "800 springs", ...
std::vector<std::string> describe_parts(const Scene& scene, const System& system);

}  // namespace foldproof
