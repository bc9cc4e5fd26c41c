// Fields of bodies: how large an octree is, how errors are measured, and how cells are chosen.
#include <catch2/catch.hpp>
#include <cmath>

#include "reference/level_set/mesh_grid.h"
#include "reference/mesh/shapes.h"
#include "reference/scene/field_accuracy.h"
#include "reference/scene/field_recipe.h"
#include "reference/scene/object_surface.h"

using namespace foldproof;
using Catch::Matchers::StartsWith;

namespace {

struct Asked {
  int cells;
};

/// A triangle far from the origin, but for one corner that is 10 m away along `axis`.
MeshDistance spike(int first) {
  PerParticle3 x(3, 3);
  x.col(first) = Vector3(10, 0.1, 0);
  x.col((first + 1) % 3) = Vector3(1, 0.3, 0);
  x.col((first + 2) % 3) = Vector3(1, -0.2, 0);
  return make_mesh_distance(x, {{0, 1, 2}});
}

MeshDistance box_distance() {
  const ObjectSurface box = box_surface({0.5, 0.75, 1.25});
  return make_mesh_distance(box.vertices, box.triangles);
}

GridSolid coarse_grid() { return {make_grid(box_distance(), {4, 2, 3, MarchingOrder::second})}; }

OctreeSolid coarse_octree() {
  const MeshDistance box = box_distance();
  return {std::make_shared<const Octree>(make_octree(
      {[box](const Vector3& p) { return box.at(p); }}, octree_about(bounds_of(box.x), 0.6, 0.05)))};
}

/// The cells that a search asks for, until the one after `count` of them.
std::vector<int> cells_asked(const Solid& answer, double accuracy, double most_bytes,
                             std::size_t count) {
  std::vector<int> asked;
  try {
    field_of_accuracy(
        box_distance(), 2.5, accuracy,
        [&](int cells) {
          if (asked.size() == count) throw Asked{cells};
          asked.push_back(cells);
          return answer;
        },
        most_bytes);
  } catch (const Asked& more) {
    asked.push_back(more.cells);
  } catch (const InputError&) {
  }
  return asked;
}

}  // namespace

TEST_CASE("an octree's cube leaves four finest cells to either side of its bounds", "[scene]") {
  const Bounds bounds(Vector3(1, 2, 3), Vector3(1.25, 9, 3.5));  // 7 m long
  const OctreeSettings s = octree_about(bounds, 1, 0.003);
  CHECK(s.depth == 4);  // 15 cells
  CHECK(s.width == 16);
  CHECK(s.corner == Vector3(1.125 - 8, 5.5 - 8, 3.25 - 8));
  CHECK(s.surface_depth == 2);
  CHECK(s.tolerance == 0.003);
  CHECK(s.band == 3);
  CHECK(s.beyond == 0.25);
  CHECK(s.reach == 0);
  CHECK(s.hanging == HangingNodes::constrained);
  CHECK(octree_about(bounds, 0.25, 1).depth == 6);  // 28 + 8 cells
  CHECK(octree_about(bounds, 0.25, 1).width == 16);
  CHECK(octree_about(bounds, 0.25, 1).surface_depth == 4);
  CHECK(octree_about(bounds, 0.25, 1).band == 0.75);
  const auto depth = [](double length) {
    return octree_about(Bounds(Vector3::Zero(), Vector3(length, 0.5, 0.25)), 1, 1).depth;
  };
  CHECK(depth(1) == 4);
  CHECK(depth(8) == 4);
  CHECK(depth(8.001) == 5);
  CHECK(depth(1048576 - 8) == 20);
  CHECK_THROWS_WITH(depth(1048577 - 8), "'cells' must be below 2^20 for an octree");
}

TEST_CASE("a field's error is measured within its triangles, out to their corners", "[scene]") {
  for (int first = 0; first < 3; ++first) {
    const MeshDistance flat = spike(first);
    // over the triangle its plane is the half space, beside it is not
    CHECK(field_error(flat, HalfSpace{}, 1) < 1e-12);
    // |p| - 0.5 against the height: largest in the far corner
    const double error = field_error(flat, Sphere{0.5}, 1e-6);
    CHECK(error < std::hypot(10, 0.1) - 0.5 + 1e-5);
    CHECK(error > 0.95 * 10 - 0.5);
  }
}

TEST_CASE("each of a body's triangles is sampled by its area", "[scene]") {
  for (const bool is_first_far : {true, false}) {
    // the far one has a hundredth of the area, and both have little
    PerParticle3 x(3, 6);
    x << 1, 1.02, 1, 10, 10.002, 10,  //
        0, 0, 0.02, 0, 0, 0.002,      //
        0, 0, 0, 0, 0, 0;
    const std::vector<Triangle> triangles = is_first_far
                                                ? std::vector<Triangle>{{3, 4, 5}, {0, 1, 2}}
                                                : std::vector<Triangle>{{0, 1, 2}, {3, 4, 5}};
    const double error = field_error(make_mesh_distance(x, triangles), Sphere{0.5}, 1e-6);
    CHECK(error > 9.49);
    CHECK(error < 9.51);
  }
}

TEST_CASE("samples lie within three cells of the surface, on either side", "[scene]") {
  // below the sphere, z and the signed distance differ by 1 + 2 h at the height h
  const TriangleMesh sphere = make_icosphere(1, 3);
  std::vector<Triangle> inverted = sphere.triangles;
  for (Triangle& t : inverted) std::swap(t[1], t[2]);
  for (const bool is_inverted : {false, true}) {
    const double error =
        field_error(make_mesh_distance(sphere.rest, is_inverted ? inverted : sphere.triangles),
                    HalfSpace{}, 0.1);
    CHECK(error < 1 + 2 * 0.3);
    CHECK(error > 1 + 2 * 0.28);
  }
}

TEST_CASE("a field that is not a number somewhere has no error to trust", "[scene]") {
  Grid broken = *coarse_grid().grid;
  // of the lower half, nodes go from below to above
  for (size_t k = 0; k < broken.phi.size() / 2; ++k) broken.phi[k] = std::nan("");
  CHECK(std::isnan(
      field_error(box_distance(), GridSolid{std::make_shared<const Grid>(broken)}, 0.1)));
}

TEST_CASE("the bytes of a field are those of its nodes, or of its tree", "[scene]") {
  const GridSolid grid = coarse_grid();
  CHECK(field_bytes(grid) == 8.0 * double(grid.grid->lattice.size()));
  const OctreeSolid octree = coarse_octree();
  CHECK(field_bytes(octree) == double(bytes(*octree.tree)));
  CHECK(field_bytes(Sphere{1}) == 0);
  CHECK(largest_field == 536870912);
}

TEST_CASE("cells grow by the excess of the error, from 16 on", "[scene]") {
  const MeshDistance box = box_distance();
  // a box a tenth of a millimetre larger: its error hardly depends on the cells
  const Box larger{{0.5001, 0.7501, 1.2501}};
  const double error = field_error(box, larger, 2.5 / 16);
  CHECK(error >= 0.99e-4);
  CHECK(error <= std::sqrt(3) * 1e-4);
  CHECK(cells_asked(larger, error * 1.0001, 1, 1) == std::vector<int>{16});
  CHECK(cells_asked(larger, error, 1, 1) == std::vector<int>{16});
  CHECK(cells_asked(larger, error / 1.1, 1, 1) == std::vector<int>{16, 20});  // at least 1.25
  CHECK(cells_asked(larger, error / 1.5, 1, 1) == std::vector<int>{16, 24});
  CHECK(cells_asked(larger, error / 1.51, 1, 1) == std::vector<int>{16, 25});
  CHECK(cells_asked(larger, error / 9, 1, 1) == std::vector<int>{16, 32});  // at most 2
  CHECK(cells_asked(larger, error / 9, 1, 2) == std::vector<int>{16, 32, 64});
  const MeasuredField found =
      field_of_accuracy(box, 2.5, 2e-4, [&](int) -> Solid { return larger; });
  CHECK(found.cells == 16);
  CHECK(found.error == error);
  CHECK(found.bytes == 0);
}

TEST_CASE("a search ends before a grid's eightfold, or an octree's fourfold, is too large",
          "[scene]") {
  for (const bool is_grid : {true, false}) {
    const Solid coarse = is_grid ? Solid(coarse_grid()) : Solid(coarse_octree());
    const double tiny = 1e-9, most = (is_grid ? 8 : 4) * field_bytes(coarse);
    CHECK(cells_asked(coarse, tiny, most, 1) == std::vector<int>{16, 32});
    CHECK(cells_asked(coarse, tiny, most - 1, 1) == std::vector<int>{16});
  }
}

TEST_CASE("an accuracy that cannot be had is refused with cells, errors and memory", "[scene]") {
  const Solid coarse = coarse_grid();
  char message[300];
  std::snprintf(message, sizeof message,
                "an error of 1e-09 m cannot be had; 16 cells have one of %.3g m, and 32 would take "
                "more than 4 MB; give a larger accuracy, or cells",
                field_error(box_distance(), coarse, 2.5 / 16));
  Grid large = *std::get<GridSolid>(coarse).grid;
  large.phi.resize(57400);
  const Solid padded = GridSolid{std::make_shared<const Grid>(large)};
  CHECK_THROWS_WITH(
      field_of_accuracy(
          box_distance(), 2.5, 1e-9, [&](int) { return padded; }, 3.5000001 * 1048576),
      std::string(message));
}

TEST_CASE("a measured field is described in cells, metres and megabytes", "[scene]") {
  CHECK(describe(MeasuredField{Sphere{1}, 48, 8.25e-4, 3.505000001 * 1048576}) ==
        "48 cells, error 0.000825 m, 3.51 MB");
}

TEST_CASE("an octree for an accuracy has half of it as tolerance", "[scene]") {
  const MeshDistance box = box_distance();
  const FieldRecipe recipe{
      OctreeRecipe{box.x, box.triangles, octree_about(bounds_of(box.x), 0.5, 0.1)}, "w", 0.25};
  Body body = RigidObject{};
  make_field(recipe, computing_provider(), body);
  const Solid& solid = std::get<RigidObject>(body).solid;
  const OctreeSettings settings = std::get<OctreeSolid>(solid).tree->settings;
  const OctreeSettings expected = octree_about(bounds_of(box.x), 2.5 / 16, 0.125);
  CHECK(settings.tolerance == 0.125);
  CHECK(settings.depth == expected.depth);
  CHECK(settings.width == Approx(expected.width).epsilon(1e-14));
  CHECK(accuracy_report(recipe, body) ==
        describe(MeasuredField{solid, 16, field_error(box, solid, 2.5 / 16), field_bytes(solid)}));
}

TEST_CASE("a field without an accuracy is of its recipe, and not reported", "[scene]") {
  const MeshDistance box = box_distance();
  const OctreeSettings settings = octree_about(bounds_of(box.x), 0.5, 0.1);
  Body body = RigidObject{};
  const FieldRecipe octree{OctreeRecipe{box.x, box.triangles, settings}, "w", 0};
  make_field(octree, computing_provider(), body);
  CHECK(std::get<OctreeSolid>(std::get<RigidObject>(body).solid).tree->settings.tolerance == 0.1);
  CHECK(accuracy_report(octree, body).empty());
  const TriangleSoup soup{box.x, box.triangles, {}};
  const GridMethod method{7, 2, 3, MarchingOrder::second};
  const FieldRecipe grid{GridRecipe{soup, method, Repair::refuse}, "w", 0};
  make_field(grid, computing_provider(), body);
  const GridSolid made = std::get<GridSolid>(std::get<RigidObject>(body).solid);
  CHECK(made.grid->phi == make_level_set(soup, method, Repair::refuse)->phi);
  FieldRecipe reported = grid;
  reported.accuracy = 0.5;
  CHECK(accuracy_report(reported, body) ==
        describe(MeasuredField{made, 7, field_error(box, made, 2.5 / 7), field_bytes(made)}));
  make_field({ExactRecipe{box.x, box.triangles}, "w", 0}, computing_provider(), body);
  CHECK(std::get<MeshSolid>(std::get<RigidObject>(body).solid).at({0, 0, 3}).phi == 1.75);
  Body deforming = DeformingObject{};
  CHECK(accuracy_report(reported, deforming).empty());
}

TEST_CASE("a grid for an accuracy keeps the rest of its method", "[scene]") {
  const MeshDistance box = box_distance();
  const TriangleSoup soup{box.x, box.triangles, {}};
  std::vector<GridMethod> asked;
  LevelSetProvider level_sets = computing_provider();
  level_sets.make_level_set = [&](const TriangleSoup& of, const GridMethod& method, Repair repair) {
    CHECK(of.rest == box.x);
    CHECK(repair == Repair::refuse);
    asked.push_back(method);
    return make_level_set(of, method, repair);
  };
  Body body = RigidObject{};
  make_field({GridRecipe{soup, {5, 2, 4, MarchingOrder::first}, Repair::refuse}, "w", 0.2},
             level_sets, body);
  REQUIRE(asked.size() == 1);
  CHECK(asked[0].cells == 16);
  CHECK(asked[0].margin == 2);
  CHECK(asked[0].band == 4);
  CHECK(asked[0].order == MarchingOrder::first);
}
