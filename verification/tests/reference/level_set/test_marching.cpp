// Fast marching, its two starts and the grid of a mesh: values worked out by hand, and bands by
// definition.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "reference/level_set/mesh_grid.h"
#include "reference/level_set/narrow_band.h"
#include "verification/specimens/random.h"

using namespace foldproof;
using Catch::Contains;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace

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

TEST_CASE("seeds from sides are the nodes with a neighbour on the other side") {
  const Lattice lattice{{-0.31, 0.17, 1.9}, 0.43, {5, 3, 4}};
  Random random(921);
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<float> side;
    for (long i = 0; i < lattice.size(); ++i) {
      const double value = random.uniform(-1, 3);  // some of them 0
      side.push_back(value > -0.6 && value < -0.1 ? 0.f : float(value));
    }
    const Seeds seeds = seeds_from_sides(lattice, side);
    std::size_t count = 0;
    for (long i = 0; i < lattice.size(); ++i) {
      double sum = 0;  // of 1/t^2 over the axes, t the nearest crossing in cells
      const Node node = lattice.node(i);
      for (int axis = 0; axis < 3; ++axis) {
        double nearest = infinity;
        for (const int step : {-1, 1}) {
          Node next = node;
          next[axis] += step;
          if (next[axis] < 0 || next[axis] >= lattice.nodes[axis]) continue;
          const double a = side[i], b = side[lattice.index(next)];
          if ((a < 0) != (b < 0)) nearest = std::min(nearest, a / (a - b));
        }
        sum += 1 / (nearest * nearest);
      }
      if (sum == 0) continue;
      REQUIRE(count < seeds.nodes.size());
      CHECK(seeds.nodes[count] == i);
      CHECK(seeds.phi[count] ==
            Approx((side[i] < 0 ? -0.43 : 0.43) / std::sqrt(sum)).epsilon(1e-14).margin(1e-300));
      ++count;
    }
    CHECK(count == seeds.nodes.size());
    CHECK(count == seeds.phi.size());
  }
}

TEST_CASE("a narrow band of one cell reaches the neighbours of a node on the surface") {
  PerParticle3 x(3, 4);
  x << 0, 8, 8, 0, 0, 0, 8, 8, 2, 2, 2, 2;
  const MeshDistance plane = make_mesh_distance(x, {{0, 1, 2}, {0, 2, 3}});
  const Lattice lattice{{1, 2, 0}, 1, {3, 4, 5}};
  CHECK(narrow_band(plane, lattice, 1).nodes.size() == 3 * 4 * 3);
  CHECK(narrow_band(plane, lattice, 1, 200).nodes == narrow_band(plane, lattice, 1, 1).nodes);
  CHECK_THROWS_AS(narrow_band(plane, lattice, std::nextafter(1.0, 0.0)), InputError);
  CHECK_THROWS_AS(narrow_band(plane, lattice, NAN), InputError);
  x.row(2).setConstant(2 + 1e-10);  // so much farther from the layer below
  const MeshDistance higher = make_mesh_distance(x, {{0, 1, 2}, {0, 2, 3}});
  CHECK(narrow_band(higher, lattice, 1).nodes.size() == 3 * 4 * 2);
}
