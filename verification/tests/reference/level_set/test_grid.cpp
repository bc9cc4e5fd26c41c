// Lattices and grids against node-by-node definitions, on values that are no distance at all.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include "reference/level_set/grid.h"
#include "verification/specimens/random.h"

using namespace foldproof;
using Catch::Contains;

namespace {

const Lattice odd{{-0.31, 0.17, 1.9}, 0.43, {5, 3, 4}};

Grid random_grid(const Lattice& lattice, unsigned seed, double least, double most) {
  Random random(seed);
  Grid grid{lattice, {}};
  for (long i = 0; i < lattice.size(); ++i) grid.phi.push_back(random.uniform(least, most));
  return grid;
}

/// Anywhere about the lattice, `beyond` of its size farther on each side.
Vector3 point_about(Random& random, const Lattice& lattice, double beyond) {
  const Bounds bounds = lattice.bounds();
  Vector3 p;
  for (int axis = 0; axis < 3; ++axis)
    p[axis] = bounds.min()[axis] + bounds.sizes()[axis] * random.uniform(-beyond, 1 + beyond);
  return p;
}

/// Differences of the nodes next to a node, over one or two spacings.
Vector3 nodal_gradient(const Grid& grid, const Node& node) {
  Vector3 gradient;
  for (int axis = 0; axis < 3; ++axis) {
    Node below = node, above = node;
    below[axis] = std::max(node[axis] - 1, 0);
    above[axis] = std::min(node[axis] + 1, grid.lattice.nodes[axis] - 1);
    gradient[axis] = (grid.phi[grid.lattice.index(above)] - grid.phi[grid.lattice.index(below)]) /
                     ((above[axis] - below[axis]) * grid.lattice.spacing);
  }
  return gradient;
}

/// The trilinear mean of phi and of the nodal gradients; the gradient as it is.
Distance blend(const Grid& grid, const Vector3& p) {
  const Vector3 steps = (p - grid.lattice.origin) / grid.lattice.spacing;
  Node cell;
  for (int axis = 0; axis < 3; ++axis)
    cell[axis] = std::min(std::max(int(std::floor(steps[axis])), 0), grid.lattice.nodes[axis] - 2);
  Distance sum{0, Vector3::Zero()};
  for (int x = 0; x < 2; ++x)
    for (int y = 0; y < 2; ++y)
      for (int z = 0; z < 2; ++z) {
        const Node node{cell[0] + x, cell[1] + y, cell[2] + z};
        double weight = 1;
        for (int axis = 0; axis < 3; ++axis) {
          const double within = steps[axis] - cell[axis];
          weight *= node[axis] == cell[axis] ? 1 - within : within;
        }
        sum.phi += weight * grid.phi[grid.lattice.index(node)];
        sum.normal += weight * nodal_gradient(grid, node);
      }
  return sum;
}

/// Six times: the surface point s that the border's point q names, then the point where the way
/// from p to s enters the lattice.
Distance search_beyond(const Grid& grid, const Vector3& p) {
  const Bounds bounds = grid.lattice.bounds();
  const Vector3 border = p.cwiseMax(bounds.min()).cwiseMin(bounds.max());
  Vector3 q = border, way;
  for (int round = 0; round < 6; ++round) {
    const Distance there = blend(grid, q);
    way = p - (q - there.phi * there.normal.normalized());
    double fraction = 0;
    for (int axis = 0; axis < 3; ++axis)
      if (p[axis] != border[axis])
        fraction = std::max(fraction, std::abs(p[axis] - border[axis]) / std::abs(way[axis]));
    q = p - std::min(fraction, 1.0) * way;
  }
  return {way.norm(), way.normalized()};
}

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

TEST_CASE("a lattice needs extent, 4 to 2^20 cells and a margin of 1 to 2^20") {
  constexpr int most = 1 << 20;
  const Vector3 low(0.5, 0.25, 0.75);
  const Bounds needle(Vector3(0, 0, 0), Vector3(3, 0, 0));
  CHECK(lattice_about(needle, most, 1).nodes == Node{most + 3, 4, 4});
  const auto refused = [](const Bounds& bounds, int cells, int margin, const char* text) {
    CHECK_THROWS_WITH(lattice_about(bounds, cells, margin), Contains(text));
  };
  refused(needle, 3, 2, "give at least 4 and 1");
  refused(needle, 5, 0, "give at least 4 and 1");
  refused(needle, most + 1, 1, "at most 2^20");
  refused(needle, 4, most, "2^30 nodes at most");
  refused(needle, 4, most + 1, "at most 2^20");
  refused(Bounds(low, low), 4, 1, "no extent");
  refused(Bounds(), 4, 1, "no extent");
  refused(Bounds(low, Vector3(INFINITY, 1, 1)), 4, 1, "no extent");
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

TEST_CASE("beyond its lattice a grid searches the nearest surface point in six steps") {
  const Grid ball = [] {
    Grid grid{{{-1.3, -1.1, -1.2}, 0.4, {8, 7, 7}}, {}};
    for (long i = 0; i < grid.lattice.size(); ++i)
      grid.phi.push_back(
          (grid.lattice.position(grid.lattice.node(i)) - Vector3(0.1, 0, -0.1)).norm() - 0.8);
    return grid;
  }();
  // values of which surface points inside and outside of the lattice follow
  for (const Grid& grid :
       {ball, random_grid(odd, 917, 0.3, 0.8), random_grid(odd, 918, -0.9, 0.9)}) {
    Random random(916);
    for (int i = 0; i < 200; ++i) {
      const Vector3 p = point_about(random, grid.lattice, 0.8);
      if (grid.lattice.bounds().contains(p)) continue;
      const Distance found = grid.at(p), expected = search_beyond(grid, p);
      CHECK(std::abs(found.phi - expected.phi) < 1e-9);
      CHECK((found.normal - expected.normal).norm() < 1e-9);
    }
  }
}
