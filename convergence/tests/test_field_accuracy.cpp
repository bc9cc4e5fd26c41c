// Fields of bodies that are made as fine as an accuracy asks.
#include <catch2/catch.hpp>
#include <random>

#include "reference/level_set/mesh_grid.h"
#include "reference/mesh/shapes.h"
#include "reference/scene/field_accuracy.h"
#include "reference/scene/field_recipe.h"
#include "reference/scene/scene.h"

using namespace foldproof;
using Catch::Matchers::Contains;

namespace {

MeshDistance distance_of_statue() {
  const TriangleMesh mesh = make_statue(0.5, 3);
  return make_mesh_distance(mesh.rest, mesh.triangles);
}

Scene scene_of(const std::string& keys) {
  return read_scene_text(
      "[cloth]\ndensity = 0.2\nshape = \"hinge\"\nlength = 1\nangle = 9\n[[object]]\n"
      "shape = \"statue\"\nheight = 0.5\nsubdivisions = 3\n" +
          keys + "[time]\nend = 1\n",
      "some.toml");
}

}  // namespace

TEST_CASE("a field of an accuracy has it, at other points too, and a coarser one has not") {
  const MeshDistance exact = distance_of_statue();
  const double longest = bounds_of(exact.x).sizes().maxCoeff(), accuracy = 0.006;
  const auto make = [&](int cells) -> Solid {
    return GridSolid{make_grid(exact, {cells, 4, 3, MarchingOrder::second})};
  };
  const MeasuredField field = field_of_accuracy(exact, longest, accuracy, make);
  CHECK(field.error <= accuracy);
  CHECK(field.error > accuracy / 8);  // a step of the search halves cells at most
  CHECK(field.bytes == field_bytes(make(field.cells)));
  CHECK(field_error(exact, field.solid, longest / field.cells) == field.error);
  CHECK(field_error(exact, make(field.cells / 2), 2 * longest / field.cells) > accuracy);
  std::mt19937 random(5);
  for (int k = 0; k < 5000; ++k) {  // other points than those of the search
    const Vector3 p =
        exact.x.col(random() % exact.x.cols()) + longest / field.cells * Vector3::NullaryExpr([&] {
                                                   return 2 * double(random()) / 4294967296.0 - 1;
                                                 });
    // largest errors at two sets of thousands of points differ by less than a half
    if (!(std::abs(distance_to(field.solid, p).phi - exact.at(p).phi) < 1.5 * accuracy))
      FAIL(p.transpose());
  }
}

TEST_CASE("an accuracy that takes more memory than is allowed is refused with the error reached") {
  const MeshDistance exact = distance_of_statue();
  const auto make = [&](int cells) -> Solid {
    return GridSolid{make_grid(exact, {cells, 4, 3, MarchingOrder::second})};
  };
  CHECK_THROWS_WITH(field_of_accuracy(exact, 0.5, 1e-5, make, 1e6),
                    Contains("an error of 1e-05 m cannot be had; 32 cells have one of 0.0"));
}

TEST_CASE("a case's accuracy decides the cells of its grid or octree, and is reported") {
  for (const std::string field : {"grid", "octree"}) {
    const Scene scene = scene_of("cells = 4\naccuracy = 0.008\nfield = \"" + field + "\"\n");
    const BuiltScene built = build(scene, computing_provider());
    const std::string report = accuracy_report(*scene.objects[0].field, built.objects[0].body);
    INFO(field << ": " << report);
    CHECK_THAT(report, Contains(" cells, error 0.00") && !Catch::StartsWith("4 cells"));
  }
  for (const std::string keys : {"field = \"exact\"\n", "repair = \"winding\"\n"})
    CHECK_THROWS_WITH(scene_of("accuracy = 0.01\n" + keys), Contains("some.toml:10: "));
}
