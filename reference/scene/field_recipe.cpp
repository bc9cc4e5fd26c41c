#include "reference/scene/field_recipe.h"

namespace foldproof {

namespace {

/// Makes one kind of field and puts it into the body.
struct FieldMaker {
  const LevelSetProvider& level_sets;
  Body& body;

  void operator()(const GridRecipe& grid) const {
    put(GridSolid{level_sets.make_level_set(grid.soup, grid.method, grid.repair)});
  }
  void operator()(const OctreeRecipe& octree) const {
    put(OctreeSolid{make_octree(level_sets, octree.x, octree.triangles, octree.settings)});
  }
  void operator()(const ExactRecipe& exact) const {
    put(MeshSolid{
        std::make_shared<const MeshDistance>(make_mesh_distance(exact.x, exact.triangles))});
  }
  void operator()(const AnimationRecipe& of) const {
    body = DeformingObject{level_sets.make_deforming_body(*of.animation, of.settings, of.between)};
  }

  void put(Solid solid) const { std::get<RigidObject>(body).solid = std::move(solid); }
};

}  // namespace

void make_field(const FieldRecipe& recipe, const LevelSetProvider& level_sets, Body& body) {
  try {
    std::visit(FieldMaker{level_sets, body}, recipe.of);
  } catch (const InputError& error) {
    const std::string message = error.what();
    if (!message.starts_with("grid: ") && !message.starts_with("octree: ")) throw;
    throw InputError(recipe.where + ": " + message);
  }
}

}  // namespace foldproof
