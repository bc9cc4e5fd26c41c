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
        for (int axis = 0; axis < 3; ++axis) weight *= 1 - std::abs(steps[axis] - node[axis]);
        // beyond the lattice, where a weight of the far node would be mirrored
        if (!grid.lattice.bounds().contains(p)) {
          weight = 1;
          for (int axis = 0; axis < 3; ++axis) {
            const double within = steps[axis] - cell[axis];
            weight *= node[axis] == cell[axis] ? 1 - within : within;
          }
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
    double share = 0;
    for (int axis = 0; axis < 3; ++axis)
      if (p[axis] != border[axis])
        share = std::max(share, std::abs(p[axis] - border[axis]) / std::abs(way[axis]));
    q = p - std::min(share, 1.0) * way;
  }
  return {way.norm(), way.normalized()};
}

}  // namespace

TEST_CASE("a lattice numbers its nodes along x, then y, then z") {
  CHECK(odd.size() == 60);
  CHECK(odd.strides() == std::array<long, 3>{1, 5, 15});
  long index = 0;
  for (int k = 0; k < 4; ++k)
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 5; ++i, ++index) {
        CHECK(odd.index({i, j, k}) == index);
        CHECK(odd.node(index) == Node{i, j, k});
        const Vector3 expected(-0.31 + 0.43 * i, 0.17 + 0.43 * j, 1.9 + 0.43 * k);
        CHECK((odd.position({i, j, k}) - expected).norm() < 1e-15);
      }
}

TEST_CASE("a lattice's bounds are its first and its last node") {
  CHECK(odd.bounds().min() == odd.origin);
  CHECK((odd.bounds().max() - Vector3(-0.31 + 4 * 0.43, 0.17 + 2 * 0.43, 1.9 + 3 * 0.43)).norm() <
        1e-15);
}

TEST_CASE("a lattice has the cells asked for along the longest side, and its margin all round") {
  const Bounds bounds(Vector3(0.1, -0.35, 2.1), Vector3(0.4, 0.35, 2.3));  // 0.3, 0.7, 0.2
  const Lattice lattice = lattice_about(bounds, 7, 2);
  CHECK(lattice.spacing == Approx(0.1).epsilon(1e-15));
  CHECK(lattice.nodes == Node{3 + 4 + 1, 7 + 4 + 1, 2 + 4 + 1});
  CHECK((lattice.origin - Vector3(-0.1, -0.55, 1.9)).norm() < 1e-14);
}

TEST_CASE("sides of a lattice are rounded up to whole cells, with the bounds in the middle") {
  const Bounds bounds(Vector3(1, 2, 3), Vector3(1.25, 6, 5.5));  // spacing 0.5
  const Lattice lattice = lattice_about(bounds, 8, 3);
  CHECK(lattice.nodes == Node{1 + 6 + 1, 8 + 6 + 1, 5 + 6 + 1});
  CHECK((lattice.origin - Vector3(1.125 - 0.25 - 1.5, 0.5, 1.5)).norm() < 1e-14);
}

TEST_CASE("a flat side of a lattice has one cell, and a rounding asks for no more") {
  const auto cells_across = [](double size) {
    const Bounds bounds(Vector3(0, 0, 0), Vector3(4, size, 0));
    return lattice_about(bounds, 4, 1).nodes[1] - 3;
  };
  CHECK(cells_across(0) == 1);
  CHECK(cells_across(0.7) == 1);
  CHECK(cells_across(3) == 3);
  CHECK(cells_across(3 + 1e-10) == 3);
  CHECK(cells_across(3 + 1e-7) == 4);
}

TEST_CASE("a lattice needs four cells and a margin of one") {
  const Bounds bounds(Vector3(0.1, 0.2, 0.3), Vector3(0.4, 0.3, 0.5));
  CHECK_NOTHROW(lattice_about(bounds, 4, 1));
  CHECK_THROWS_WITH(lattice_about(bounds, 3, 2),
                    Contains("grid: 3 cells along the longest side and a margin of 2;"));
  CHECK_THROWS_WITH(lattice_about(bounds, 5, 0), Contains("a margin of 0; give at least 4 and 1"));
}

TEST_CASE("a lattice of up to 2^20 cells along its longest side is accepted, a margin likewise") {
  constexpr int most = 1 << 20;
  const Bounds needle(Vector3(0, 0, 0), Vector3(3, 0, 0));
  CHECK(lattice_about(needle, most, 1).nodes == Node{most + 3, 4, 4});
  CHECK_THROWS_WITH(lattice_about(needle, most + 1, 1), Contains("at most 2^20"));
  CHECK_THROWS_WITH(lattice_about(needle, 4, most), Contains("2^30 nodes at most"));
  CHECK_THROWS_WITH(lattice_about(needle, 4, most + 1), Contains("at most 2^20"));
}

TEST_CASE("a lattice has at most 2^30 nodes") {
  const Bounds cube(Vector3(0, 0, 0), Vector3(3, 3, 3));
  CHECK(lattice_about(cube, 1021, 1).size() == 1L << 30);
  CHECK_THROWS_WITH(lattice_about(cube, 1022, 1),
                    Contains("grid: 1025 x 1025 x 1025 nodes; give fewer cells"));
  CHECK_THROWS_WITH(lattice_about(Bounds(Vector3(0, 0, 0), Vector3(3, 0.5, 1)), 1 << 20, 1 << 20),
                    Contains("grid: 3145729 x 2271916 x 2446679 nodes;"));
}

TEST_CASE("a lattice needs bounds of finite extent, be it small") {
  const Vector3 low(0.5, 0.25, 0.75);
  CHECK(lattice_about(Bounds(low, low + Vector3(0.01, 0, 0)), 4, 1).spacing == Approx(0.0025));
  CHECK_THROWS_WITH(lattice_about(Bounds(low, low), 4, 1), Contains("no extent"));
  CHECK_THROWS_WITH(lattice_about(Bounds(), 4, 1), Contains("no extent"));
  CHECK_THROWS_WITH(lattice_about(Bounds(low, Vector3(INFINITY, 1, 1)), 4, 1),
                    Contains("no extent"));
}

TEST_CASE("a grid blends its nodes' values and differences, one-sided at the border") {
  for (const Lattice& lattice : {odd, Lattice{{1.1, -2.3, 0.7}, 3.7, {2, 3, 2}}}) {
    const Grid grid = random_grid(lattice, 911, -1, 2);
    Random random(912);
    for (int i = 0; i < 200; ++i) {
      const Vector3 p = point_about(random, lattice, 0);
      const Distance found = grid.at(p), expected = blend(grid, p);
      CHECK(std::abs(found.phi - expected.phi) < 1e-13);
      CHECK((found.normal - expected.normal.normalized()).norm() < 1e-12);
    }
  }
}

TEST_CASE("at its nodes a grid has their values, in every corner too") {
  const Grid grid = random_grid(odd, 913, -1, 2);
  for (long i = 0; i < odd.size(); ++i)
    CHECK(std::abs(grid.at(odd.position(odd.node(i))).phi - grid.phi[i]) < 1e-13);
}

TEST_CASE("a grid without slope has no normal, one with little has a unit normal") {
  Grid grid{odd, std::vector<double>(60, 0)};
  CHECK(grid.at({0.1, 0.5, 2.2}).normal == Vector3::Zero());
  for (long i = 0; i < odd.size(); ++i) grid.phi[i] = 0.001 * odd.node(i)[1];
  CHECK((grid.at({0.1, 0.5, 2.2}).normal - Vector3(0, 1, 0)).norm() < 1e-12);
}

TEST_CASE("in a cell a grid's gradient is that of the trilinear interpolant") {
  const Grid grid = random_grid(odd, 914, -1, 2);
  Random random(915);
  for (int i = 0; i < 100; ++i) {
    const Vector3 p = point_about(random, odd, 0);
    const Distance found = grid.in_cell(p);
    CHECK(std::abs(found.phi - blend(grid, p).phi) < 1e-13);
    for (int axis = 0; axis < 3; ++axis) {
      // linear along each axis: from one face of the cell to the other
      const double steps = (p[axis] - odd.origin[axis]) / odd.spacing;
      Vector3 low = p, high = p;
      low[axis] = odd.origin[axis] + odd.spacing * std::floor(steps);
      high[axis] = low[axis] + odd.spacing;
      const double slope = (blend(grid, high).phi - blend(grid, low).phi) / odd.spacing;
      CHECK(std::abs(found.normal[axis] - slope) < 1e-11);
    }
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

TEST_CASE("where a point is no place, a grid's distance is no number and its normal is zero") {
  const Grid grid = random_grid(odd, 919, -1, 2);
  for (const double bad : {double(NAN), double(INFINITY), -double(INFINITY)}) {
    const Distance found = grid.at({0.1, bad, 2.2});
    CHECK(std::isnan(found.phi));
    CHECK(found.normal == Vector3::Zero());
  }
}
