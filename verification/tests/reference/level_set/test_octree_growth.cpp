// The growth of an octree against a slow one that knows each cell by its place alone.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "reference/level_set/octree_growth.h"

using namespace foldproof;

namespace {

using Key = std::array<int, 4>;  // level, then x, y, z among the cells of that level

Key key_of(const OctreePlace& place) {
  return {place.level, place.cell[0], place.cell[1], place.cell[2]};
}

/// Which cells are branches, with which parts, by definition.
struct SlowTree {
  const std::vector<DistanceFunction>& bodies;
  const OctreeSettings& settings;
  std::set<Key> grown, added;
  std::map<Key, std::vector<int>> known_parts;

  double half_diagonal(int level) const {
    return std::sqrt(3.0) / 2 * settings.width / (1 << level);
  }

  BranchNodes<double> nodes(int part, const Key& cell) const {
    BranchNodes<double> phi;
    for (int n = 0; n < 27; ++n) {
      const Vector3 steps(2 * cell[1] + n % 3, 2 * cell[2] + n / 3 % 3, 2 * cell[3] + n / 9);
      phi[n] = bodies[part](settings.corner + settings.width * (steps / (2 << cell[0]))).phi;
    }
    return phi;
  }

  /// Those of the wider cell's that may be nearest, or within reach, somewhere in the cell.
  std::vector<int> parts(const Key& cell) {
    const auto known = known_parts.find(cell);
    if (known != known_parts.end()) return known->second;
    std::vector<int> candidates;
    if (cell[0] == 0)
      for (int k = 0; k < int(bodies.size()); ++k) candidates.push_back(k);
    else
      candidates = parts(parent(cell));
    double nearest = INFINITY;
    for (const int k : candidates) nearest = std::min(nearest, nodes(k, cell)[13]);
    std::vector<int> found;
    const double half = half_diagonal(cell[0]);
    for (const int k : candidates) {
      const double least = nodes(k, cell)[13] - half;
      if (least <= nearest + half || least <= settings.reach) found.push_back(k);
    }
    return known_parts[cell] = found;
  }

  static Key parent(const Key& cell) {
    return {cell[0] - 1, cell[1] / 2, cell[2] / 2, cell[3] / 2};
  }

  /// The interpolant of the corners misses a node by more than is allowed there.
  bool is_missed(const BranchNodes<double>& phi) const {
    for (int n = 0; n < 27; ++n) {
      const int at[] = {n % 3, n / 3 % 3, n / 9};
      double mean = 0;
      for (int c = 0; c < 8; ++c) {
        const int corner[] = {c & 1 ? 2 : 0, c & 2 ? 2 : 0, c & 4 ? 2 : 0};
        double weight = 1;
        for (int axis = 0; axis < 3; ++axis) weight *= 1 - 0.5 * std::abs(at[axis] - corner[axis]);
        mean += weight * phi[corner[0] + 3 * corner[1] + 9 * corner[2]];
      }
      const double beyond = std::max(std::abs(phi[n]) - settings.band, 0.0);
      if (std::abs(mean - phi[n]) > settings.tolerance + settings.beyond * beyond) return true;
    }
    return false;
  }

  bool wants_split(const Key& cell) {
    std::vector<BranchNodes<double>> phi;
    for (const int k : parts(cell)) phi.push_back(nodes(k, cell));
    for (std::size_t k = 0; k < phi.size(); ++k) {
      if (cell[0] < settings.surface_depth && std::abs(phi[k][13]) <= half_diagonal(cell[0]))
        return true;
      if (needs_channel(phi, k, settings.reach) && is_missed(phi[k])) return true;
    }
    return false;
  }

  void grow(const Key& cell) {
    grown.insert(cell);
    if (cell[0] + 1 >= settings.depth) return;
    for (int c = 0; c < 8; ++c) {
      const Key child{cell[0] + 1, 2 * cell[1] + c % 2, 2 * cell[2] + c / 2 % 2,
                      2 * cell[3] + c / 4};
      if (wants_split(child)) grow(child);
    }
  }

  bool is_branch(const Key& cell) const { return grown.count(cell) || added.count(cell); }

  void add(const Key& cell) {
    if (cell[0] > 0) add(parent(cell));
    if (!is_branch(cell)) added.insert(cell);
  }

  /// All cells about a branch exist: their parents are branches. Again until nothing is missing.
  void balance() {
    for (std::size_t before = 0; before != grown.size() + added.size();) {
      before = grown.size() + added.size();
      std::vector<Key> all(grown.begin(), grown.end());
      all.insert(all.end(), added.begin(), added.end());
      for (const Key& cell : all)
        for (int d = 0; d < 27; ++d) {
          const Key next{cell[0], cell[1] + d % 3 - 1, cell[2] + d / 3 % 3 - 1,
                         cell[3] + d / 9 - 1};
          const int cells = 1 << cell[0];
          if (cell[0] > 0 && *std::min_element(next.begin() + 1, next.end()) >= 0 &&
              *std::max_element(next.begin() + 1, next.end()) < cells)
            add(parent(next));
        }
    }
  }

  /// All parts at the cube's nodes; the 98 finer nodes of each grown cell that might be split
  /// further; the 27 nodes of each that was added.
  long evaluations() {
    long sum = 27 * long(bodies.size());
    for (const Key& cell : grown)
      if (cell[0] + 1 < settings.depth) sum += 98 * long(parts(cell).size());
    for (const Key& cell : added) sum += 27 * long(parts(parent(cell)).size());
    return sum;
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
  SlowTree slow{bodies, settings, {}, {}, {}};
  slow.grow({0, 0, 0, 0});
  slow.balance();
  const Octree tree = make_octree(bodies, settings);
  CHECK(tree.evaluations == slow.evaluations());

  // breadth first, children in the order of their numbers
  std::vector<Key> order{{0, 0, 0, 0}};
  for (std::size_t b = 0; b < order.size(); ++b)
    for (int c = 0; c < 8; ++c) {
      const Key cell = order[b];
      const Key child{cell[0] + 1, 2 * cell[1] + c % 2, 2 * cell[2] + c / 2 % 2,
                      2 * cell[3] + c / 4};
      if (slow.is_branch(child)) order.push_back(child);
    }
  const std::vector<OctreePlace> places = branch_places(tree);
  REQUIRE(places.size() == order.size());
  for (std::size_t b = 0; b < places.size(); ++b) {
    REQUIRE(key_of(places[b]) == order[b]);
    const std::vector<int> parts = slow.parts(order[b]);
    std::vector<BranchNodes<double>> phi;
    for (const int k : parts) phi.push_back(slow.nodes(k, order[b]));
    const OctreeBranch& branch = tree.branches[b];
    int channel = branch.channels;
    for (std::size_t k = 0; k < parts.size(); ++k) {
      if (!needs_channel(phi, k, settings.reach)) continue;
      REQUIRE(channel < branch.channels + branch.parts);
      CHECK(tree.part[channel] == parts[k]);
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
}

TEST_CASE("an octree's cells are no different in a wide cube, nor where it is all one part") {
  std::vector<DistanceFunction> wide;
  for (const DistanceFunction& body : some_bodies())
    wide.push_back([body](const Vector3& p) {
      const Distance unit = body((p - Vector3(-7, 3, 11)) / 16);
      return Distance{16 * unit.phi, unit.normal};
    });
  OctreeSettings settings = sampling(5);
  settings.corner = {-7, 3, 11};
  settings.width = 16;
  settings.tolerance = 0.03;
  settings.band = 0.4;
  settings.reach = 0.5;
  check_growth(wide, settings);
  check_growth({wide[2]}, settings);
}

TEST_CASE("fine cells in every corner of the cube make neighbours inside of it only") {
  for (int corner = 0; corner < 8; ++corner) {
    const Vector3 centre(corner & 1 ? 0.93 : 0.06, corner & 2 ? 0.94 : 0.07,
                         corner & 4 ? 0.92 : 0.05);
    OctreeSettings settings = sampling(6);
    settings.tolerance = 2e-3;
    settings.band = 0.004;
    settings.beyond = 0.5;
    check_growth({[&](const Vector3& p) { return Sphere{0.045}.at(p - centre); }}, settings);
  }
}

TEST_CASE("constrained nodes are the means of their branch's corners, the others are kept") {
  OctreeSettings settings = sampling(5);
  const Octree loose = make_octree(some_bodies(), settings);
  settings.hanging = HangingNodes::constrained;
  const Octree tree = make_octree(some_bodies(), settings);
  REQUIRE(tree.phi.size() == loose.phi.size());
  int constrained = 0;
  const std::vector<OctreePlace> places = branch_places(tree);
  for (std::size_t b = 0; b < places.size(); ++b) {
    const std::uint32_t hanging = hanging_nodes(tree, places[b]);
    const OctreeBranch& branch = tree.branches[b];
    for (int k = branch.channels; k < branch.channels + branch.parts; ++k)
      for (int n = 0; n < 27; ++n) {
        const bool hangs = hanging >> n & 1;
        CHECK(tree.phi[k][n] == (hangs ? corner_mean(loose.phi[k], n) : loose.phi[k][n]));
        constrained += hangs;
      }
  }
  CHECK(constrained > 0);
}

TEST_CASE("a part just within reach, or just as near as the nearest may be, is sampled") {
  const double half = 0.5 * std::sqrt(3.0);  // of the cube's diagonal [m]
  OctreeSettings settings = sampling(2);
  settings.surface_depth = 0;
  settings.reach = 1;
  const auto evaluations = [&](double first, double second) {
    return make_octree({constant(first), constant(second)}, settings).evaluations;
  };
  const double at_reach = 1 + half;
  REQUIRE(at_reach - half == 1);
  CHECK(evaluations(0.1, at_reach) == 2 * (27 + 98));
  CHECK(evaluations(0.1, at_reach + 1e-15) == 2 * 27 + 98);
  CHECK(evaluations(at_reach + 1e-15, 0.1) == 2 * 27 + 98);
  settings.reach = 0;
  const double nearest = 0.25 + half, as_near = nearest + half;
  REQUIRE(as_near - half == nearest);
  CHECK(evaluations(0.25, as_near) == 2 * (27 + 98));
  CHECK(evaluations(as_near, 0.25) == 2 * (27 + 98));
  CHECK(evaluations(0.25, as_near + 1e-15) == 2 * 27 + 98);
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

TEST_CASE("a part needs a channel if it is within reach at a node, be it the last") {
  BranchNodes<double> near, far;
  near.fill(0.5);
  far.fill(0.75);
  CHECK_FALSE(needs_channel({near, far}, 1, 0.625));
  for (const int n : {0, 13, 26}) {
    BranchNodes<double> part = far;
    part[n] = 0.625;
    CHECK(needs_channel({near, part}, 1, 0.625));
    CHECK_FALSE(needs_channel({near, part}, 1, std::nextafter(0.625, 0.0)));
  }
}

TEST_CASE("a part needs a channel unless a single other one is nowhere farther") {
  BranchNodes<double> near, far;
  near.fill(0.5);
  far.fill(0.75);
  CHECK(needs_channel({near, far}, 0, 0));
  CHECK_FALSE(needs_channel({near, far}, 1, 0));
  CHECK_FALSE(needs_channel({far, near}, 0, 0));
  for (const int n : {0, 13, 26}) {
    BranchNodes<double> crossing = far, touching = far;
    crossing[n] = 0.25;
    touching[n] = 0.5;
    CHECK(needs_channel({near, crossing}, 1, 0));
    CHECK(needs_channel({near, crossing}, 0, 0));
    CHECK_FALSE(needs_channel({near, touching}, 1, 0));
    CHECK(needs_channel({near, touching}, 0, 0));
    // each of two others is farther somewhere
    BranchNodes<double> other = near;
    other[n] = 1;
    BranchNodes<double> third = near;
    third[(n + 5) % 27] = 1;
    CHECK(needs_channel({other, third, far}, 2, 0));
    CHECK_FALSE(needs_channel({other, near, far}, 2, 0));
  }
}

TEST_CASE("of parts alike at all nodes the first keeps its channel") {
  BranchNodes<double> alike;
  alike.fill(0.5);
  CHECK(needs_channel({alike, alike, alike}, 0, 0));
  CHECK_FALSE(needs_channel({alike, alike, alike}, 1, 0));
  CHECK_FALSE(needs_channel({alike, alike, alike}, 2, 0));
}

TEST_CASE("growth begins without any evaluation") {
  const std::vector<DistanceFunction> bodies = some_bodies();
  const OctreeSettings settings = sampling(3);
  CHECK(OctreeGrowth{bodies, settings, {}, {}, {}}.evaluations == 0);
}
