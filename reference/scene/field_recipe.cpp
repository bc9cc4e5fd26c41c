#include "reference/scene/field_recipe.h"

#include <cmath>

#include "reference/bodies/thin_parts.h"
#include "reference/scene/field_accuracy.h"

namespace foldproof {

namespace {

struct LostParts {
  double fraction = 0;  // of the surface
  std::string text;
};

LostParts lost_parts(const GridRecipe& recipe, const Grid& grid) {
  const TriangleSoup& soup = recipe.soup;
  const bool is_repaired = recipe.repair == Repair::winding;
  const auto found = find_thin_parts(
      soup.rest, is_repaired ? outward_patches(soup).triangles : soup.triangles, grid);
  if (!found) return {};
  return {found->lost,
          describe(*found, grid, bounds_of(soup.rest).sizes().maxCoeff(), recipe.repair)};
}

/// Makes one kind of field and puts it into the body.
struct FieldMaker {
  const LevelSetProvider& level_sets;
  Body& body;
  double accuracy;  // m; 0: none

  void operator()(const GridRecipe& grid) const {
    Solid solid = accuracy > 0
                      ? with_accuracy(grid.soup.rest, grid.soup.triangles, grid)
                      : GridSolid{level_sets.make_level_set(grid.soup, grid.method, grid.repair)};
    const LostParts lost = lost_parts(grid, *std::get<GridSolid>(solid).grid);
    if (lost.fraction > 0.5) throw InputError("grid: the body is too thin for it: " + lost.text);
    put(std::move(solid));
  }
  void operator()(const OctreeRecipe& octree) const {
    if (accuracy > 0) return put(with_accuracy(octree.x, octree.triangles, octree));
    put(OctreeSolid{make_octree(level_sets, {octree.triangles, {0}, {octree.x}, octree.inside},
                                octree.settings)});
  }
  void operator()(const ExactRecipe& exact) const {
    put(MeshSolid{
        std::make_shared<const MeshDistance>(make_mesh_distance(exact.x, exact.triangles))});
  }
  void operator()(const AnimationRecipe& of) const {
    body = DeformingObject{level_sets.make_deforming_body(*of.animation, of.settings, of.between)};
  }

  Solid of_cells(GridRecipe grid, int cells) const {
    grid.method.cells = cells;
    return GridSolid{level_sets.make_level_set(grid.soup, grid.method, grid.repair)};
  }
  /// Half the accuracy goes to the tolerance, so that finer cells can reach the rest.
  Solid of_cells(const OctreeRecipe& octree, int cells) const {
    const Bounds bounds = bounds_of(octree.x);
    const OctreeSettings settings =
        octree_about(bounds, bounds.sizes().maxCoeff() / cells, accuracy / 2);
    return OctreeSolid{make_octree(level_sets, {octree.triangles, {0}, {octree.x}}, settings)};
  }

  template <class Recipe>
  Solid with_accuracy(const PerParticle3& x, const std::vector<Triangle>& triangles,
                      const Recipe& recipe) const {
    return field_of_accuracy(make_mesh_distance(x, triangles), bounds_of(x).sizes().maxCoeff(),
                             accuracy, [&](int cells) { return of_cells(recipe, cells); })
        .solid;
  }

  void put(Solid solid) const { std::get<RigidObject>(body).solid = std::move(solid); }
};

}  // namespace

OctreeSettings octree_about(const Bounds& bounds, double cell, double tolerance) {
  const double least = bounds.sizes().maxCoeff() / cell + 8;
  const double levels = std::ceil(std::log2(least));
  if (!(levels <= 20)) throw InputError("'cells' must be below 2^20 for an octree");
  const int depth = int(levels);  // 3 or more
  const double width = std::ldexp(cell, depth);
  const Vector3 corner = bounds.center() - Vector3::Constant(width / 2);
  return {corner, width, depth, depth - 2, tolerance, 3 * cell, 0.25, 0, HangingNodes::constrained};
}

void make_field(const FieldRecipe& recipe, const LevelSetProvider& level_sets, Body& body) {
  try {
    std::visit(FieldMaker{level_sets, body, recipe.accuracy}, recipe.of);
  } catch (const InputError& error) {
    const std::string message = error.what();
    if (!message.starts_with("grid: ") && !message.starts_with("octree: ") &&
        !message.starts_with("mesh sequence: ") && !message.starts_with("'cells' ") &&
        !message.starts_with("an error of "))
      throw;
    throw InputError(recipe.where + ": " + message);
  }
}

std::string lost_parts_report(const FieldRecipe& recipe, const Body& body) {
  const auto* grid = std::get_if<GridRecipe>(&recipe.of);
  return grid ? lost_parts(*grid, *std::get<GridSolid>(std::get<RigidObject>(body).solid).grid).text
              : "";
}

std::string accuracy_report(const FieldRecipe& recipe, const Body& body) {
  const auto* object = std::get_if<RigidObject>(&body);
  if (!(recipe.accuracy > 0) || !object) return "";
  const auto report = [&](const PerParticle3& x, const std::vector<Triangle>& triangles,
                          double cell) {
    const double error = field_error(make_mesh_distance(x, triangles), object->solid, cell);
    const double longest = bounds_of(x).sizes().maxCoeff();
    return describe(MeasuredField{object->solid, int(std::lround(longest / cell)), error,
                                  field_bytes(object->solid)});
  };
  if (const auto* grid = std::get_if<GridRecipe>(&recipe.of))
    return report(grid->soup.rest, grid->soup.triangles,
                  std::get<GridSolid>(object->solid).grid->lattice.spacing);
  const auto& octree = std::get<OctreeRecipe>(recipe.of);
  const OctreeSettings& settings = std::get<OctreeSolid>(object->solid).tree->settings;
  return report(octree.x, octree.triangles, std::ldexp(settings.width, -settings.depth));
}

}  // namespace foldproof
