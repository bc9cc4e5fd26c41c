// Bodies of triangles in [[object]]: rigid ones in a frame of their own, deforming ones
// in the world's.
#pragma once

#include <memory>
#include <string>

#include "reference/level_set/solid.h"
#include "reference/motion/pose.h"
#include "reference/scene/field_recipe.h"
#include "reference/scene/key_file.h"
#include "reference/scene/object_surface.h"
#include "reference/scene/scene_limits.h"

namespace foldproof {

/// Context of a body beyond its keys.
struct CaseContext {
  std::string folder;  // base of relative paths in the case
  double end;          // of the run [s]
  const SceneLimits& limits;
};

/// A solid in its own frame, with its surface.
struct BodyShape {
  Solid solid;  // lacks its field if there is a recipe for it
  ObjectSurface surface;
  std::shared_ptr<const FieldRecipe> field = {};
  double scale = 1;  // by 'fit'
};

/// True if the body deforms: `frames` or [[object.deform]].
bool is_deforming(const KeyTable& keys);

/// `shape = "statue"` or `mesh`, as the exact distance, a grid or an octree of it: `field`,
/// `cells`, `tolerance`, or `accuracy`. Throws InputError for a mesh that is not closed, unless it
/// is to be repaired.
BodyShape read_mesh_body(const KeyTable& keys, const CaseContext& context);

struct DeformingShape {
  std::shared_ptr<const MeshSequence> animation;
  std::shared_ptr<const FieldRecipe> field;
  double scale = 1;  // by 'fit'
};

/// `frames` or [[object.deform]] of a body of triangles, in its place before it deforms. Throws
/// InputError "file:line: frame ..." for a frame that is not a closed mesh.
DeformingShape read_deforming_body(const KeyTable& keys, const Pose& place,
                                   const CaseContext& context);

}  // namespace foldproof
