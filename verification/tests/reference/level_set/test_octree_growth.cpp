// The growth of an octree against a slow one that knows each cell by its place alone.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <set>

#include "reference/level_set/octree_growth.h"

using namespace foldproof;

namespace {

using Key = std::array<int, 4>;  // level, then x, y, z among the cells of that level

OctreePlace place_of(const Key& cell) { return {cell[0], {cell[1], cell[2], cell[3]}}; }

Key parent_of(const Key& cell) { return {cell[0] - 1, cell[1] / 2, cell[2] / 2, cell[3] / 2}; }

Key child_of(const Key& cell, int c) {
  return {cell[0] + 1, 2 * cell[1] + c % 2, 2 * cell[2] + c / 2 % 2, 2 * cell[3] + c / 4};
}

/// Which cells are branches, by definition.
struct SlowTree {
  const std::vector<DistanceFunction>& bodies;
  const OctreeSettings& settings;
  std::set<Key> branches;

  /// Each body's values at the nodes of the cell as a branch.
  std::vector<BranchNodes<double>> nodes(const Key& cell) const {
    std::vector<BranchNodes<double>> phi(bodies.size());
    for (std::size_t k = 0; k < bodies.size(); ++k)
      for (int n = 0; n < 27; ++n)
        phi[k][n] = bodies[k](node_position(settings, place_of(cell), n)).phi;
    return phi;
  }

  /// The interpolant of the corners misses a node by more than is allowed there.
  bool is_missed(const BranchNodes<double>& phi) const {
    for (int n = 0; n < 27; ++n) {
      const double beyond = std::max(std::abs(phi[n]) - settings.band, 0.0);
      if (std::abs(corner_mean(phi, n) - phi[n]) > settings.tolerance + settings.beyond * beyond)
        return true;
    }
    return false;
  }

  bool wants_split(const Key& cell) const {
    const std::vector<BranchNodes<double>> phi = nodes(cell);
    const double half_diagonal = std::sqrt(3.0) / 2 * settings.width / (1 << cell[0]);
    for (std::size_t k = 0; k < phi.size(); ++k) {
      if (cell[0] < settings.surface_depth && std::abs(phi[k][13]) <= half_diagonal) return true;
      if (needs_channel(phi, k, settings.reach) && is_missed(phi[k])) return true;
    }
    return false;
  }

  void grow(const Key& cell) {
    branches.insert(cell);
    for (int c = 0; c < 8 && cell[0] + 1 < settings.depth; ++c)
      if (wants_split(child_of(cell, c))) grow(child_of(cell, c));
  }

  void add(const Key& cell) {
    if (cell[0] > 0) add(parent_of(cell));
    branches.insert(cell);
  }

  /// All cells about a branch exist: their parents are branches. Again until nothing is missing.
  void balance() {
    for (std::size_t before = 0; before != branches.size();) {
      before = branches.size();
      for (const Key& cell : std::set<Key>(branches))
        for (int d = 0; d < 27; ++d) {
          const Key next{cell[0], cell[1] + d % 3 - 1, cell[2] + d / 3 % 3 - 1,
                         cell[3] + d / 9 - 1};
          const auto [low, high] = std::minmax_element(next.begin() + 1, next.end());
          if (cell[0] > 0 && *low >= 0 && *high < 1 << cell[0]) add(parent_of(next));
        }
    }
  }
};

/// Two balls that overlap, one in a corner of the cube, and a capsule far from them.
std::vector<DistanceFunction> some_bodies() {
  return {[](const Vector3& p) { return Sphere{0.17}.at(p - Vector3(0.19, 0.2, 0.185)); },
          [](const Vector3& p) { return Sphere{0.11}.at(p - Vector3(0.37, 0.31, 0.22)); },
          [](const Vector3& p) {
            return Capsule{0.06, 0.13}.at(p - Vector3(0.87, 0.66, 0.79));
          }};
}

OctreeSettings sampling(int depth) {
  return {{0, 0, 0}, 1, depth, 2, 3e-3, 0.05, 0.2, 0.03, HangingNodes::free};
}

DistanceFunction constant(double phi) {
  return [phi](const Vector3&) { return Distance{phi, Vector3::Zero()}; };
}

void check_growth(const std::vector<DistanceFunction>& bodies, const OctreeSettings& settings) {
  SlowTree slow{bodies, settings, {}};
  slow.grow({0, 0, 0, 0});
  slow.balance();
  const Octree tree = make_octree(bodies, settings);
  // breadth first, children in the order of their numbers
  std::vector<Key> order{{0, 0, 0, 0}};
  for (std::size_t b = 0; b < order.size(); ++b)
    for (int c = 0; c < 8; ++c)
      if (const Key child = child_of(order[b], c); slow.branches.count(child))
        order.push_back(child);
  const std::vector<OctreePlace> places = branch_places(tree);
  REQUIRE(places.size() == order.size());
  for (std::size_t b = 0; b < places.size(); ++b) {
    REQUIRE(places[b].level == order[b][0]);
    REQUIRE(places[b].cell == place_of(order[b]).cell);
    const std::vector<BranchNodes<double>> phi = slow.nodes(order[b]);
    const OctreeBranch& branch = tree.branches[b];
    int channel = branch.channels;
    for (std::size_t k = 0; k < phi.size(); ++k) {
      if (!needs_channel(phi, k, settings.reach)) continue;
      REQUIRE(channel < branch.channels + branch.parts);
      CHECK(tree.part[channel] == int(k));
      CHECK(tree.phi[channel] == phi[k]);
      ++channel;
    }
    CHECK(channel == branch.channels + branch.parts);
  }
}

}  // namespace

TEST_CASE("an octree splits the cells that its settings ask for, and those that balance it") {
  check_growth(some_bodies(), sampling(6));
  OctreeSettings settings = sampling(5);
  settings.tolerance = 0.3;  // the surface's depth alone decides
  settings.surface_depth = 3;
  check_growth(some_bodies(), settings);
  settings.beyond = 0;
  settings.band = 0.01;
  settings.tolerance = 4e-3;
  settings.surface_depth = 0;
  settings.reach = 0.2;
  check_growth(some_bodies(), settings);

  std::vector<DistanceFunction> wide;
  for (const DistanceFunction& body : some_bodies())
    wide.push_back([body](const Vector3& p) {
      const Distance unit = body((p - Vector3(-7, 3, 11)) / 16);
      return Distance{16 * unit.phi, unit.normal};
    });
  check_growth(wide, {{-7, 3, 11}, 16, 5, 2, 0.03, 0.4, 0.2, 0.5, HangingNodes::free});

  // fine cells in every corner of the cube have neighbours inside of it only
  for (int corner = 0; corner < 8; ++corner) {
    const Vector3 centre(corner & 1 ? 0.93 : 0.06, corner & 2 ? 0.94 : 0.07,
                         corner & 4 ? 0.92 : 0.05);
    check_growth({[&](const Vector3& p) { return Sphere{0.045}.at(p - centre); }},
                 {{0, 0, 0}, 1, 6, 2, 2e-3, 0.004, 0.5, 0.03, HangingNodes::free});
  }
}

TEST_CASE("a cell whose corners just reach a surface counts as holding it") {
  const double half = 0.25 * std::sqrt(3.0);  // of the diagonal of half the cube [m]
  const auto branches = [](double phi) {
    return make_octree({constant(phi)}, sampling(3)).branches.size();
  };
  CHECK(branches(half) == 9);
  CHECK(branches(std::nextafter(half, 1.0)) == 1);
}

TEST_CASE("a cell is split where it misses by more than is allowed, not by just as much") {
  // 8, and 1/4 more at odd nodes along x
  const DistanceFunction bumps = [](const Vector3& p) {
    return Distance{8 + 0.25 * (int(p.x()) % 2), Vector3::Zero()};
  };
  OctreeSettings settings = sampling(2);
  settings.width = 4;
  settings.surface_depth = 0;
  const auto branches = [&](double tolerance, double beyond, double band) {
    settings.tolerance = tolerance;
    settings.beyond = beyond;
    settings.band = band;
    return make_octree({bumps}, settings).branches.size();
  };
  CHECK(branches(0.25, 0, 0) == 1);
  CHECK(branches(std::nextafter(0.25, 0.0), 0, 0) == 9);
  // 1/16 + (8.25 - 6.75)/8
  CHECK(branches(0.0625, 0.125, 6.75) == 1);
  CHECK(branches(0.0625, 0.125, 6.75 + 1e-6) == 9);
  // in the band nothing is taken off
  CHECK(branches(0.25, 0.125, 20) == 1);
}

TEST_CASE("a part needs a channel within reach, or unless another is nowhere farther") {
  BranchNodes<double> near, far;
  near.fill(0.5);
  far.fill(0.75);
  CHECK(needs_channel({near, far}, 0, 0));
  CHECK_FALSE(needs_channel({near, far}, 1, 0.625));
  CHECK_FALSE(needs_channel({far, near}, 0, 0));
  for (const int n : {0, 13, 26}) {
    BranchNodes<double> reaching = far, crossing = far, touching = far, other = near, third = near;
    reaching[n] = 0.625;
    crossing[n] = 0.25;
    touching[n] = 0.5;
    CHECK(needs_channel({near, reaching}, 1, 0.625));
    CHECK_FALSE(needs_channel({near, reaching}, 1, std::nextafter(0.625, 0.0)));
    CHECK(needs_channel({near, crossing}, 1, 0));
    CHECK(needs_channel({near, crossing}, 0, 0));
    CHECK_FALSE(needs_channel({near, touching}, 1, 0));
    // each of two others is farther somewhere
    other[n] = third[(n + 5) % 27] = 1;
    CHECK(needs_channel({other, third, far}, 2, 0));
    CHECK_FALSE(needs_channel({other, near, far}, 2, 0));
  }
  // of parts alike at all nodes the first has the channel
  for (int part = 0; part < 3; ++part)
    CHECK(needs_channel({near, near, near}, std::size_t(part), 0) == (part == 0));
}
