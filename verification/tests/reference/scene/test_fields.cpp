// Fields of bodies: how large an octree is, how errors are measured, and how cells are chosen.
#include <catch2/catch.hpp>
#include <cmath>

#include "reference/level_set/mesh_grid.h"
#include "reference/mesh/shapes.h"
#include "reference/scene/field_accuracy.h"
#include "reference/scene/field_recipe.h"
#include "reference/scene/object_surface.h"

using namespace foldproof;
using Catch::Matchers::Contains;

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

TEST_CASE("a field that is not a number somewhere has no error to trust", "[scene]") {
  Grid broken = *coarse_grid().grid;
  // of the lower half, nodes go from below to above
  for (size_t k = 0; k < broken.phi.size() / 2; ++k) broken.phi[k] = std::nan("");
  CHECK(std::isnan(
      field_error(box_distance(), GridSolid{std::make_shared<const Grid>(broken)}, 0.1)));
}

TEST_CASE("cells grow by the excess of the error, until a finer field is too large", "[scene]") {
  const MeshDistance box = box_distance();
  // a box a tenth of a millimetre larger: its error hardly depends on the cells
  const Box larger{{0.5001, 0.7501, 1.2501}};
  const double error = field_error(box, larger, 2.5 / 16);
  CHECK(error >= 0.99e-4);
  CHECK(error <= std::sqrt(3) * 1e-4);
  using Cells = std::vector<int>;
  CHECK(cells_asked(larger, error, 1, 1) == Cells{16});
  CHECK(cells_asked(larger, error / 1.1, 1, 1) == Cells{16, 20});  // at least 1.25
  CHECK(cells_asked(larger, error / 1.51, 1, 1) == Cells{16, 25});
  CHECK(cells_asked(larger, error / 9, 1, 2) == Cells{16, 32, 64});  // at most 2
  // a grid grows eightfold, an octree fourfold
  for (const bool is_grid : {true, false}) {
    const Solid coarse = is_grid ? Solid(coarse_grid()) : Solid(coarse_octree());
    const double most = (is_grid ? 8 : 4) * field_bytes(coarse);
    CHECK(cells_asked(coarse, 1e-9, most, 1) == Cells{16, 32});
    CHECK(cells_asked(coarse, 1e-9, most - 1, 1) == Cells{16});
  }
  const auto make = [](int) -> Solid { return coarse_grid(); };
  CHECK_THROWS_WITH(field_of_accuracy(box, 2.5, 1e-9, make, 1),
                    Contains("an error of 1e-09 m cannot be had; 16 cells have one of ") &&
                        Contains(" m, and 32 would take more than 0 MB"));
}
