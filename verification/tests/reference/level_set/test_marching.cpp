// Fast marching: values worked out by hand.
#include <catch2/catch.hpp>

#include <cmath>
#include <stdexcept>

#include "reference/level_set/mesh_grid.h"

using namespace foldproof;
using Catch::Contains;

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

TEST_CASE("marching leaves out neighbours that are no upwind ones, and takes the nearer of two") {
  const Lattice lattice{{0, 0, 0}, 1, {3, 3, 1}};
  const auto middle = [&](double left, double right, double below) {
    return march(lattice, {{3, 5, 1}, {left, right, below}}, MarchingOrder::first).phi[4];
  };
  CHECK(middle(0.25, 0.5, 1.5) == 1.25);
  CHECK(middle(0.5, 0.25, 1.25) == 1.25);
  const double root = 0.5 * (0.25 + 0.75 + std::sqrt(2 - 0.25));
  CHECK(middle(0.25, 0.5, 0.75) == Approx(root).epsilon(1e-15));
  CHECK(middle(0.5, 0.25, 0.75) == Approx(root).epsilon(1e-15));
}

TEST_CASE("marching needs seeds, which part inside from outside, -0 being inside") {
  const Lattice lattice{{0.3, 0.7, -0.2}, 0.5, {3, 4, 3}};
  const Seeds inside{{lattice.index({1, 1, 1})}, {-0.0}},
      seeds{{lattice.index({1, 1, 1}), lattice.index({1, 2, 1})}, {-0.0, 0.5}};
  CHECK(march(lattice, inside, MarchingOrder::first).phi[lattice.index({1, 2, 1})] ==
        Approx(-0.5).epsilon(1e-15));
  CHECK_THROWS_AS(march(lattice, seeds, MarchingOrder::first), std::logic_error);
  CHECK_THROWS_WITH(march(lattice, {}, MarchingOrder::first), Contains("give a finer grid"));
}
