// Fields of bodies that are made as fine as an accuracy asks.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "reference/level_set/mesh_grid.h"
#include "reference/mesh/shapes.h"
#include "reference/scene/field_accuracy.h"
#include "reference/scene/field_recipe.h"
#include "reference/scene/scene.h"

using namespace foldproof;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

namespace {

MeshDistance distance_of(const TriangleMesh& mesh) {
  return make_mesh_distance(mesh.rest, mesh.triangles);
}

Solid grid_of(const MeshDistance& mesh, int cells) {
  return GridSolid{make_grid(mesh, {cells, 4, 3, MarchingOrder::second})};
}

Scene scene_of(const std::string& keys) {
  return read_scene_text(
      "[cloth]\ndensity = 0.2\nshape = \"hinge\"\nlength = 1\nangle = 9\n[[object]]\n"
      "shape = \"statue\"\nheight = 0.5\nsubdivisions = 3\n" +
          keys + "[time]\nend = 1\n",
      "some.toml");
}

/// The largest error at other points than those of the search.
double error_elsewhere(const MeshDistance& exact, const Solid& field) {
  std::mt19937 random(5);
  const double cell = std::get<GridSolid>(field).grid->lattice.spacing;
  double largest = 0;
  for (int k = 0; k < 5000; ++k) {
    const auto share = [&] { return double(random()) / 4294967296.0; };
    const Eigen::Index vertex = Eigen::Index(share() * double(exact.x.cols()));
    const Vector3 p =
        exact.x.col(vertex) + 2 * cell * Vector3(share() - 0.5, share() - 0.5, share() - 0.5);
    largest = std::max(largest, std::abs(distance_to(field, p).phi - exact.at(p).phi));
  }
  return largest;
}

}  // namespace

TEST_CASE("a field of an accuracy has it, at other points too, and a coarser one has not") {
  const MeshDistance exact = distance_of(make_statue(0.5, 3));
  const double longest = bounds_of(exact.x).sizes().maxCoeff(), accuracy = 0.006;
  const auto make = [&](int cells) { return grid_of(exact, cells); };
  const MeasuredField field = field_of_accuracy(exact, longest, accuracy, make);
  CHECK(field.error <= accuracy);
  CHECK(field.error > accuracy / 8);  // a step of the search halves cells at most
  CHECK(field.bytes == field_bytes(make(field.cells)));
  CHECK(field_error(exact, field.solid, longest / field.cells) == field.error);
  // largest errors at two sets of thousands of points differ by less than a half
  CHECK(error_elsewhere(exact, field.solid) < 1.5 * accuracy);
  CHECK(field_error(exact, make(field.cells / 2), 2 * longest / field.cells) > accuracy);
}

TEST_CASE("an accuracy that takes more memory than is allowed is refused with the error reached") {
  const MeshDistance exact = distance_of(make_statue(0.5, 3));
  const auto make = [&](int cells) { return grid_of(exact, cells); };
  CHECK_THROWS_WITH(field_of_accuracy(exact, 0.5, 1e-5, make, 1e6),
                    Contains("an error of 1e-05 m cannot be had; 32 cells have one of 0.0"));
}

TEST_CASE("a case's accuracy decides the cells of its grid or octree, and is reported") {
  for (const char* field : {"grid", "octree"}) {
    INFO(field);
    const Scene scene =
        scene_of("cells = 4\naccuracy = 0.008\nfield = \"" + std::string(field) + "\"\n");
    const BuiltScene built = build(scene, computing_provider());
    const std::string report = accuracy_report(*scene.objects[0].field, built.objects[0].body);
    CHECK_THAT(report, Contains(" cells, error 0.00"));
    CHECK_THAT(report, !StartsWith("4 cells"));
    const auto* recipe = std::get_if<GridRecipe>(&scene.objects[0].field->of);
    if (!recipe) continue;
    const Solid& solid = std::get<RigidObject>(built.objects[0].body).solid;
    const double cells = bounds_of(recipe->soup.rest).sizes().maxCoeff() /
                         std::get<GridSolid>(solid).grid->lattice.spacing;
    CHECK_THAT(report, StartsWith(std::to_string(std::lround(cells)) + " cells, "));
  }
  CHECK_THROWS_WITH(scene_of("accuracy = 0.01\nfield = \"exact\"\n"),
                    Contains("some.toml:10: field = \"exact\" has no error to choose"));
  CHECK_THROWS_WITH(scene_of("accuracy = 0.01\nrepair = \"winding\"\n"),
                    Contains("some.toml:10: a mesh that is repaired has no exact distance"));
}

TEST_CASE("what a recipe's keys decide is refused at their place, and nothing else is") {
  const std::string grid = "grid: too fine", octree = "octree: too fine",
                    cells = "'cells' must be less", accuracy = "an error of 1 m cannot be had",
                    other = "the mesh has no triangle";
  const FieldRecipe recipe{GridRecipe{}, "some.toml:7", 0};
  Body body = RigidObject{};
  for (const std::string& said : {grid, octree, cells, accuracy, other}) {
    const LevelSetProvider refuses{
        [&](const TriangleSoup&, const GridMethod&, Repair) -> std::shared_ptr<const Grid> {
          throw InputError(said);
        },
        {}};
    CHECK_THROWS_WITH(make_field(recipe, refuses, body),
                      said == other ? said : "some.toml:7: " + said);
  }
}
