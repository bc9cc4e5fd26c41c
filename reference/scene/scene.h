// A case after reading and validation, before anything is built: a recipe.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "reference/beyond/air.h"
#include "reference/beyond/membrane.h"
#include "reference/dynamics/simulate.h"
#include "reference/filters/object_collision.h"
#include "reference/filters/self_collision.h"
#include "reference/filters/strain_limit.h"
#include "reference/forces/force.h"
#include "reference/mesh/seams.h"
#include "reference/mesh/triangle_mesh.h"
#include "reference/motion/motion.h"
#include "reference/scene/cloth_fabrics.h"
#include "reference/scene/scene_limits.h"
#include "reference/types.h"

namespace foldproof {

struct LevelSetProvider;  // bodies/level_set_provider.h
struct FieldRecipe;       // scene/field_recipe.h

/// An object, and its surface as triangles: for pictures, not for collisions.
struct SceneObject {
  // if there is a recipe for the body's field, the field is missing until it is built
  Object object;
  std::shared_ptr<const FieldRecipe> field;  // if the body is a triangle mesh
  std::string shape;                         // in words
  PerParticle3 vertices;  // 3 x V, before its motion, or in its first frame if it deforms [m]
  std::vector<Triangle> triangles;                // outward
  std::shared_ptr<const MeshSequence> animation;  // if the body deforms
  double scale = 1;                               // of its mesh, by 'fit'
};

/// The surface's vertices at time t [s], 3 x V [m].
PerParticle3 surface_at(const SceneObject& part, double t);

/// Their velocities, 3 x V [m/s]; where they jump, the later ones.
PerParticle3 surface_velocity_at(const SceneObject& part, double t);

/// Settings of the collision between cloth and objects.
struct CollisionSettings {
  double forecast_time = 0;  // tau [s]; 0: the step
  PointKind points = PointKind::particles;
  std::string response = "forecast";
};

/// A scene names its parts; a part that it does not name is not built and costs nothing.
struct Scene {
  std::string name, title, about;
  std::string text;  // the case file with its overrides, empty for scenes made by code
  // of the case file, base of its relative files; empty for scenes made by code
  std::string folder;

  TriangleMesh mesh;   // with the rest shape
  PerParticle3 x, v;   // start, 3 x N [m], [m/s]
  double density = 0;  // area density [kg/m^2], of the first fabric if there are several
  // N: the original of each particle whose vertex was split, else the particle itself
  // (mesh/split_fans.h); empty without splits
  std::vector<int> copy_of = {};
  UnsewnMesh unsewn = {};  // of a mesh file whose `seams` were closed, and of one copy
  ClothFabrics fabrics = {};

  std::optional<Vector3> gravity;          // m/s^2
  std::optional<StretchMaterial> stretch;  // of the first fabric, as the next
  std::optional<BendingMaterial> bending;
  std::optional<MembraneMaterial> membrane;
  ByDirection stretch_directions = {}, bending_directions = {};
  std::optional<Air> air;
  std::vector<double> rest_angles;  // one per hinge [rad], if there is bending
  std::vector<PrescribedParticle> prescribed;
  std::vector<std::string> notes;     // of how input is taken; a sentence each
  std::vector<std::string> warnings;  // input that is allowed, but seldom meant; a sentence each
  std::vector<SceneObject> objects;
  CollisionSettings collision;
  std::optional<StrainLimits> strain_limits;  // needs stretch
  std::optional<SelfCollisionSettings> self_collision;
  std::vector<StickyPatch> sticky;  // patches that cloth may stick to

  std::string integrator = "C";
  Schedule schedule;
  SolverSettings solver;
};

/// A scene of the mesh at rest in its rest shape, without any force.
Scene scene_at_rest(TriangleMesh mesh, double density);

/// A case file, parsed once; all parts are read from this tree.
struct CaseKeys {
  std::string path, text;          // the file's, overrides noted at the end of the text
  std::shared_ptr<KeyTable> keys;  // with the overrides
};

/// Parses a case file. Throws InputError "file:line: ..." for invalid TOML.
///   overrides   "a.b=c", applied in order
CaseKeys parse_case(const std::string& path, const std::vector<std::string>& overrides);

/// The same for text; `path` names it in messages; relative mesh files are read from its folder.
CaseKeys parse_case_text(const std::string& text, const std::string& path,
                         const std::vector<std::string>& overrides);

/// The scene that the keys describe; no level set is computed. Throws InputError "file:line: ..."
/// for anything invalid; unknown keys are reported by reject_unused of the tree, after all parts
/// were read. See cases/KEYS.md for the keys.
Scene scene_from(const CaseKeys& of, const SceneLimits& limits = {});

/// The scene of a case file alone: its tables [expect] and [ablation] are ignored. Throws
/// InputError as above, and for any other unknown key.
Scene read_scene(const std::string& path, const std::vector<std::string>& overrides = {});
Scene read_scene_text(const std::string& text, const std::string& path,
                      const std::vector<std::string>& overrides = {},
                      const SceneLimits& limits = {});

/// A system and its initial state.
struct BuiltScene {
  System system;
  State start;
  // with the fields of their bodies; for checks, instead of the system's own
  std::vector<Object> objects;
};

/// Builds what the scene names, and nothing else. level_sets: source of the bodies' level sets.
/// Throws InputError, naming the place of the key if it was read from a file, for a level set that
/// cannot be made.
BuiltScene build(const Scene& scene, const LevelSetProvider& level_sets);

/// The system of build(), its level sets computed.
System build_system(const Scene& scene);

State start_state(const Scene& scene);

/// The scene's objects, with the fields of their bodies.
std::vector<Object> build_objects(const Scene& scene, const LevelSetProvider& level_sets);

/// Describes what was built, a phrase for each part: "289 particles, 512 triangles", "gravity",
/// "800 springs", ...
std::vector<std::string> describe_parts(const Scene& scene, const System& system);

}  // namespace foldproof
