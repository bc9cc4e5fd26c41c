// Recipe for the field of a triangle-mesh body, kept from reading a case until the build.
#pragma once

#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "reference/bodies/level_set_provider.h"
#include "reference/level_set/object.h"

namespace foldproof {

struct GridRecipe {
  TriangleSoup soup;  // in the body's frame [m]
  GridMethod method;
  Repair repair;
};

struct OctreeRecipe {
  PerParticle3 x;  // 3 x V, in the body's frame [m]
  std::vector<Triangle> triangles;
  OctreeSettings settings;
};

/// The exact distance to the triangles.
struct ExactRecipe {
  PerParticle3 x;  // 3 x V, in the body's frame [m]
  std::vector<Triangle> triangles;
};

struct AnimationRecipe {
  std::shared_ptr<const MeshSequence> animation;  // in the world's frame
  OctreeSettings settings;
  BetweenFrames between;
};

struct FieldRecipe {
  std::variant<GridRecipe, OctreeRecipe, ExactRecipe, AnimationRecipe> of;
  std::string where;  // "file:line" of the key that sets its resolution; for error messages
};

/// Gives the body the field that the recipe describes. Throws InputError with the recipe's place
/// for a field that is too fine, and whatever the provider throws.
void make_field(const FieldRecipe& recipe, const LevelSetProvider& level_sets, Body& body);

}  // namespace foldproof
