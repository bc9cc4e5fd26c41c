// Level sets on grids: lattices, and marching.
#include <catch2/catch.hpp>
#include <cmath>

#include "reference/level_set/fast_marching.h"
#include "reference/level_set/grid.h"

using namespace foldproof;

using Catch::Contains;

namespace {

const Lattice odd{{-0.31, 0.17, 1.9}, 0.43, {5, 3, 4}};

}  // namespace

TEST_CASE("a lattice has whole cells all round its bounds, a rounding adds none") {
  const auto check = [](const Vector3& sizes, int cells, int margin, const Node& across) {
    const Vector3 low(0.25, -0.5, 2);
    const Lattice lattice = lattice_about(Bounds(low, low + sizes), cells, margin);
    CHECK(lattice.spacing == Approx(sizes.maxCoeff() / cells).epsilon(1e-15));
    for (int axis = 0; axis < 3; ++axis) {
      CHECK(lattice.nodes[axis] == across[axis] + 2 * margin + 1);
      const double more = across[axis] * lattice.spacing - sizes[axis];
      CHECK(lattice.origin[axis] ==
            Approx(low[axis] - margin * lattice.spacing - more / 2).epsilon(1e-13));
    }
  };
  check({0.3, 0.7, 0.2}, 7, 2, {3, 7, 2});
  check({0.25, 4, 2.5}, 8, 3, {1, 8, 5});
  check({4, 0.7, 0}, 4, 1, {4, 1, 1});
  check({4, 3 + 1e-10, 3 + 1e-7}, 4, 1, {4, 3, 4});
  check({0.01, 0, 0}, 4, 1, {4, 1, 1});
}

TEST_CASE("a lattice has at most 2^30 nodes") {
  const Bounds cube(Vector3(0, 0, 0), Vector3(3, 3, 3));
  CHECK(lattice_about(cube, 1021, 1).size() == 1L << 30);
  CHECK_THROWS_WITH(lattice_about(cube, 1022, 1),
                    Contains("grid: 1025 x 1025 x 1025 nodes; give fewer cells"));
  CHECK_THROWS_WITH(lattice_about(Bounds(Vector3(0, 0, 0), Vector3(3, 0.5, 1)), 1 << 20, 1 << 20),
                    Contains("grid: 3145729 x 2271916 x 2446679 nodes;"));
}

TEST_CASE("a grid has a unit normal or, without slope or a finite place, none") {
  Grid grid{odd, std::vector<double>(60, 0)};
  CHECK(grid.at({0.1, 0.5, 2.2}).normal == Vector3::Zero());
  for (long i = 0; i < odd.size(); ++i) grid.phi[i] = 0.001 * odd.node(i)[1];
  CHECK((grid.at({0.1, 0.5, 2.2}).normal - Vector3(0, 1, 0)).norm() < 1e-12);
  for (const double bad : {double(NAN), double(INFINITY), -double(INFINITY)}) {
    const Distance found = grid.at({0.1, bad, 2.2});
    CHECK(std::isnan(found.phi));
    CHECK(found.normal == Vector3::Zero());
  }
}

TEST_CASE("marching takes differences of second order where values fall towards the surface") {
  // along a row of three nodes, the last unknown
  const auto last = [](double first, double second, MarchingOrder order) {
    const Lattice row{{0, 0, 0}, 2, {3, 1, 1}};
    return march(row, {{0, 1}, {first, second}}, order).phi[2];
  };
  CHECK(last(0.25, 1, MarchingOrder::first) == 3);
  CHECK(last(0.25, 1, MarchingOrder::second) == Approx((4 - 0.25) / 3 + 4.0 / 3).epsilon(1e-15));
  CHECK(last(1, 1, MarchingOrder::second) == Approx(1 + 4.0 / 3).epsilon(1e-15));
  CHECK(last(1.25, 1, MarchingOrder::second) == 3);
  CHECK(last(-0.25, 1, MarchingOrder::second) == 3);  // on the other side
  CHECK(last(0, 1, MarchingOrder::second) == Approx(8.0 / 3).epsilon(1e-15));
}
