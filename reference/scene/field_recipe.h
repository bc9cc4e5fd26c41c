// Recipe for the field of a triangle-mesh body, kept from reading a case until the build.
#pragma once

#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "reference/bodies/level_set_provider.h"
#include "reference/level_set/object.h"
#include "reference/mesh/box_tree.h"

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
  Inside inside = Inside::normals;
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
  // for grids and octrees of one mesh: the largest error allowed [m], which sets the number of
  // cells (field_accuracy.h); 0: the cells of the recipe
  double accuracy = 0;
};

/// An octree about the bounds, its finest cells `cell` [m] wide and the bounds four of them away
/// from its sides. Cells that may hold the surface are no wider than four finest ones, and the band
/// is three to either side. tolerance [m]. Throws InputError for more than 2^20 cells.
OctreeSettings octree_about(const Bounds& bounds, double cell, double tolerance);

/// Gives the body the field that the recipe describes. Throws InputError with the recipe's place
/// for a field that is too fine or an accuracy out of reach, for a grid without an inside behind
/// half of the surface, and anything that the provider throws.
void make_field(const FieldRecipe& recipe, const LevelSetProvider& level_sets, Body& body);

/// The thin parts that a grid loses (bodies/thin_parts.h), in words; "" for other fields.
std::string lost_parts_report(const FieldRecipe& recipe, const Body& body);

/// Cells, measured error and bytes of a field built for an accuracy; "" for others.
std::string accuracy_report(const FieldRecipe& recipe, const Body& body);

}  // namespace foldproof
