// Fast marching, its two starts and the grid of a mesh, against slow searches by definition.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <set>
#include <stdexcept>

#include "reference/level_set/mesh_grid.h"
#include "reference/level_set/narrow_band.h"
#include "verification/specimens/random.h"

using namespace foldproof;
using Catch::Contains;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

struct Term {
  double value, weight;
};

/// Marches by the definition: of all trial values the least, of equal ones that of the lowest
/// index, becomes known; then its neighbours' trial values are found anew.
struct SlowMarch {
  Lattice lattice;
  MarchingOrder order;
  std::vector<double> phi;
  std::vector<char> known;

  bool contains(const Node& node) const {
    for (int axis = 0; axis < 3; ++axis)
      if (node[axis] < 0 || node[axis] >= lattice.nodes[axis]) return false;
    return true;
  }

  /// Known, and not on the side opposite to `sign`.
  bool serves(const Node& node, double sign) const {
    if (!contains(node)) return false;
    const long index = lattice.index(node);
    return known[index] && sign * phi[index] >= 0;
  }

  /// The nearer of the two neighbours along an axis; with the one behind it if order and values
  /// allow: 3 T - 4 T1 + T2 over 2 h.
  Term along(const Node& node, int axis, double sign) const {
    const double h2 = lattice.spacing * lattice.spacing;
    double nearest = infinity;
    Term term{infinity, 1 / h2};
    for (const int step : {-1, 1}) {
      Node next = node, behind = node;
      next[axis] += step;
      behind[axis] += 2 * step;
      if (!serves(next, sign)) continue;
      const double one = std::abs(phi[lattice.index(next)]);
      if (one >= nearest) continue;
      nearest = one;
      term = {one, 1 / h2};
      if (order == MarchingOrder::first || !serves(behind, sign)) continue;
      const double two = std::abs(phi[lattice.index(behind)]);
      if (two <= one) term = {(4 * one - two) / 3, 2.25 / h2};
    }
    return term;
  }

  /// sum of weight max(0, T - value)^2 = 1, by bisection.
  static double root(const std::array<Term, 3>& terms, double spacing) {
    double low = infinity;
    for (const Term& term : terms) low = std::min(low, term.value);
    double high = low + 2 * spacing;
    for (int i = 0; i < 200; ++i) {
      const double middle = 0.5 * (low + high);
      double sum = 0;
      for (const Term& term : terms)
        sum += term.weight * std::pow(std::max(0.0, middle - term.value), 2);
      (sum < 1 ? low : high) = middle;
    }
    return low;
  }

  void update_about(const Node& node) {
    const double sign = std::signbit(phi[lattice.index(node)]) ? -1 : 1;
    for (int axis = 0; axis < 3; ++axis)
      for (const int step : {-1, 1}) {
        Node next = node;
        next[axis] += step;
        if (!contains(next) || known[lattice.index(next)]) continue;
        std::array<Term, 3> terms{along(next, 0, sign), along(next, 1, sign), along(next, 2, sign)};
        std::sort(terms.begin(), terms.end(),
                  [](const Term& a, const Term& b) { return a.value < b.value; });
        phi[lattice.index(next)] = sign * root(terms, lattice.spacing);
      }
  }

  std::vector<double> run(const Seeds& seeds) {
    phi.assign(lattice.size(), infinity);
    known.assign(lattice.size(), 0);
    for (std::size_t i = 0; i < seeds.nodes.size(); ++i) {
      phi[seeds.nodes[i]] = seeds.phi[i];
      known[seeds.nodes[i]] = 1;
    }
    for (const long seed : seeds.nodes) update_about(lattice.node(seed));
    for (;;) {
      long next = -1;
      for (long i = 0; i < lattice.size(); ++i)
        if (!known[i] && std::isfinite(phi[i]) &&
            (next < 0 || std::abs(phi[i]) < std::abs(phi[next]) * (1 - 1e-12)))
          next = i;
      if (next < 0) return phi;
      known[next] = 1;
      update_about(lattice.node(next));
    }
  }
};

/// Nodes with |phi| below `width`.
Seeds seeds_of(const Lattice& lattice, const std::function<double(const Vector3&)>& phi,
               double width) {
  Seeds seeds;
  for (long i = 0; i < lattice.size(); ++i) {
    const double value = phi(lattice.position(lattice.node(i)));
    if (!(std::abs(value) < width)) continue;
    seeds.nodes.push_back(i);
    seeds.phi.push_back(value);
  }
  return seeds;
}

void check_march(const Lattice& lattice, const Seeds& seeds) {
  for (const MarchingOrder order : {MarchingOrder::first, MarchingOrder::second}) {
    const Grid grid = march(lattice, seeds, order);
    const std::vector<double> expected = SlowMarch{lattice, order, {}, {}}.run(seeds);
    double worst = 0;
    for (long i = 0; i < lattice.size(); ++i)
      worst = std::max(worst, std::abs(grid.phi[i] - expected[i]));
    CHECK(worst < 1e-12);
  }
}

/// An irregular tetrahedron about a point.
MeshDistance tetrahedron(const Vector3& centre, double size) {
  PerParticle3 x(3, 4);
  x << 0.9, -0.7, -0.3, 0.2, -0.1, 0.8, -0.9, 0.1, -0.4, -0.5, -0.2, 0.8;
  x = (size * x).colwise() + centre;
  return make_mesh_distance(x, {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {1, 0, 2}});
}

void check_band(const MeshDistance& mesh, const Lattice& lattice, double cells) {
  const Seeds seeds = narrow_band(mesh, lattice, cells);
  std::vector<std::pair<long, double>> found, expected;
  REQUIRE(seeds.nodes.size() == seeds.phi.size());
  for (std::size_t i = 0; i < seeds.nodes.size(); ++i)
    found.push_back({seeds.nodes[i], seeds.phi[i]});
  std::sort(found.begin(), found.end());
  for (long i = 0; i < lattice.size(); ++i) {
    const double phi = mesh.at(lattice.position(lattice.node(i))).phi;
    if (std::abs(phi) < cells * lattice.spacing) expected.push_back({i, phi});
  }
  REQUIRE(found.size() == expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    CHECK(found[i].first == expected[i].first);
    CHECK(std::abs(found[i].second - expected[i].second) < 1e-13);
  }
}

}  // namespace

TEST_CASE("marching takes the least trial value first and upwind differences only") {
  const Lattice lattice{{-0.31, 0.17, 1.9}, 0.23, {11, 9, 10}};
  const Vector3 ball(0.83, 0.97, 2.77), corner(0.1, 1.7, 3.6);
  check_march(lattice,
              seeds_of(
                  lattice, [&](const Vector3& p) { return (p - ball).norm() - 0.55; }, 2.3 * 0.23));
  // a surface that leaves the lattice, and two that approach each other
  check_march(lattice,
              seeds_of(
                  lattice, [&](const Vector3& p) { return (p - corner).norm() - 0.9; }, 0.5));
  check_march(lattice, seeds_of(
                           lattice,
                           [&](const Vector3& p) {
                             return std::min((p - Vector3(0.3, 0.6, 2.3)).norm() - 0.31,
                                             (p - Vector3(1.5, 1.4, 3.4)).norm() - 0.35);
                           },
                           0.24));
}

TEST_CASE("marching on a coarse lattice and from a single node is no different") {
  const Lattice lattice{{1, -2, 3}, 1.7, {4, 6, 5}};
  check_march(lattice, {{lattice.index({1, 2, 3})}, {0.4}});
  check_march(lattice, {{lattice.index({3, 0, 4}), lattice.index({2, 0, 4})}, {-0.3, -1.1}});
  check_march(lattice, {{lattice.index({1, 2, 3}), lattice.index({2, 2, 3})}, {0.0, 1.7}});
}

TEST_CASE("nodes at equal distances become known in the order of their indices") {
  const Lattice lattice{{-3.5, -3.5, -3.5}, 1, {8, 8, 8}};
  check_march(lattice, seeds_of(
                           lattice, [](const Vector3& p) { return p.norm() - 1.1; }, 1.9));
  const Lattice thin{{-3.5, -0.5, -0.5}, 1, {8, 2, 2}};
  check_march(thin, seeds_of(
                        thin, [](const Vector3& p) { return p.norm() + 0.3; }, 1.2));
}

TEST_CASE("from one node the first values of marching are those worked out by hand") {
  const Lattice lattice{{0.3, 0.7, -0.2}, 0.5, {4, 4, 4}};
  const Node seed{1, 1, 1};
  const Grid grid = march(lattice, {{lattice.index(seed)}, {0.2}}, MarchingOrder::second);
  const auto phi = [&](int i, int j, int k) { return grid.phi[lattice.index({i, j, k})]; };
  CHECK(phi(2, 1, 1) == Approx(0.7).epsilon(1e-14));  // one neighbour: T = 0.2 + h
  CHECK(phi(1, 0, 1) == Approx(0.7).epsilon(1e-14));
  CHECK(phi(1, 1, 3) == Approx(1.2).epsilon(1e-14));  // two-node: (4 0.7 - 0.2)/3 + (2/3) h
  CHECK(phi(2, 2, 1) == Approx(0.7 + 0.5 / std::sqrt(2)).epsilon(1e-14));  // two equal values
  // of three equal values: T + h/sqrt(3)
  CHECK(phi(0, 0, 0) == Approx(0.7 + 0.5 / std::sqrt(2) + 0.5 / std::sqrt(3)).epsilon(1e-14));
}

TEST_CASE("marching keeps its seeds, inside and on the surface too") {
  const Lattice lattice{{0.3, 0.7, -0.2}, 0.5, {3, 4, 3}};
  const Seeds seeds{{lattice.index({1, 1, 1}), lattice.index({1, 2, 1})}, {-0.0, 0.5}};
  const Seeds inside{{lattice.index({1, 1, 1})}, {-0.0}};
  CHECK(march(lattice, inside, MarchingOrder::first).phi[lattice.index({1, 2, 1})] ==
        Approx(-0.5).epsilon(1e-15));
  CHECK_THROWS_AS(march(lattice, seeds, MarchingOrder::first), std::logic_error);
  CHECK_THROWS_WITH(march(lattice, seeds, MarchingOrder::first), Contains("inside from outside"));
}

TEST_CASE("marching without seeds is refused") {
  const Lattice lattice{{0.3, 0.7, -0.2}, 0.5, {3, 4, 3}};
  CHECK_THROWS_AS(march(lattice, {}, MarchingOrder::first), InputError);
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

TEST_CASE("a narrow band holds the nodes nearer than its width, wherever the mesh is") {
  Random random(922);
  for (int trial = 0; trial < 60; ++trial) {
    const Lattice lattice{{-0.31, 0.17, 1.9}, trial % 2 ? 1.7 : 0.43, {9, 8, 11}};
    Vector3 centre;
    for (int axis = 0; axis < 3; ++axis)
      centre[axis] =
          lattice.origin[axis] + lattice.spacing * random.uniform(-0.4, lattice.nodes[axis] - 0.6);
    const double size = lattice.spacing * (trial % 3 ? 0.1 : 1.4);
    check_band(tetrahedron(centre, size), lattice, trial % 5 ? 1 + 0.3 * (trial % 4) : 2.5);
  }
}

TEST_CASE("a narrow band of a wall across the rows has all nodes along them") {
  PerParticle3 x(3, 4);
  x << 0.13, 0.13, 0.13, 0.13, -40, 40, 40, -40, -40, -40, 40, 40;
  const MeshDistance wall = make_mesh_distance(x, {{0, 1, 2}, {0, 2, 3}});
  for (const double spacing : {0.5, 1.7})
    check_band(wall, {{-3 * spacing, 0, 0}, spacing, {13, 5, 6}}, 3.2);
}

TEST_CASE("a narrow band of one cell reaches the neighbours of a node on the surface") {
  PerParticle3 x(3, 4);
  x << 0, 8, 8, 0, 0, 0, 8, 8, 2, 2, 2, 2;
  const MeshDistance plane = make_mesh_distance(x, {{0, 1, 2}, {0, 2, 3}});
  const Lattice lattice{{1, 2, 0}, 1, {3, 4, 5}};
  CHECK(narrow_band(plane, lattice, 1).nodes.size() == 3 * 4 * 3);
  x.row(2).setConstant(2 + 1e-10);  // so much farther from the layer below
  const MeshDistance higher = make_mesh_distance(x, {{0, 1, 2}, {0, 2, 3}});
  CHECK(narrow_band(higher, lattice, 1).nodes.size() == 3 * 4 * 2);
}

TEST_CASE("a narrow band needs at least one cell") {
  const Lattice lattice{{0, 0, 0}, 0.5, {4, 5, 6}};
  const MeshDistance mesh = tetrahedron({1, 1, 1}, 0.5);
  CHECK_NOTHROW(narrow_band(mesh, lattice, 1));
  CHECK_THROWS_WITH(narrow_band(mesh, lattice, std::nextafter(1.0, 0.0)),
                    Contains("narrow_band: 1.000000 cells; give at least 1"));
  CHECK_THROWS_AS(narrow_band(mesh, lattice, NAN), InputError);
}

TEST_CASE("a mesh's grid covers the whole mesh and continues its band by marching") {
  const MeshDistance mesh = tetrahedron({0.3, -0.2, 0.9}, 1.2);
  const GridMethod method{9, 2, 2.2, MarchingOrder::second};
  const std::shared_ptr<const Grid> grid = make_grid(mesh, method);
  const Lattice expected = lattice_about(bounds_of(mesh.x), 9, 2);
  CHECK(grid->lattice.nodes == expected.nodes);
  CHECK(grid->lattice.origin == expected.origin);
  CHECK(grid->phi == march(expected, narrow_band(mesh, expected, 2.2), MarchingOrder::second).phi);
  CHECK(GridSolid{grid}.at({0.4, 0.1, 1.1}).phi == grid->at({0.4, 0.1, 1.1}).phi);
}
