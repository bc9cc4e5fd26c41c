#include "reference/level_set/octree_growth.h"

#include <algorithm>
#include <cmath>

#include "reference/fast/loops.h"

namespace foldproof {

namespace {

constexpr int centre = 13;                      // of the nodes of a branch
constexpr std::size_t most_branches = 1 << 24;  // about 5 GB during the build
constexpr std::size_t batch = 1024;             // branches whose children are found at once

double cell_width(const OctreeSettings& settings, int level) {
  return std::ldexp(settings.width, -level);
}

double half_diagonal(const OctreeSettings& settings, int level) {
  return 0.5 * std::sqrt(3.0) * cell_width(settings, level);
}

double sample(const OctreeGrowth& growth, int part, const Vector3& p) {
  return growth.bodies[part](p).phi;
}

/// Some bodies and their values at the nodes of one cell.
struct Samples {
  std::vector<int> part;
  std::vector<BranchNodes<double>> phi;
};

Samples take_samples(OctreeGrowth& growth, const std::vector<int>& parts,
                     const OctreePlace& place) {
  Samples samples{parts, std::vector<BranchNodes<double>>(parts.size())};
  growth.evaluations += 27 * long(parts.size());
  for (std::size_t k = 0; k < parts.size(); ++k)
    for (int n = 0; n < 27; ++n)
      samples.phi[k][n] = sample(growth, parts[k], node_position(growth.settings, place, n));
  return samples;
}

int add_branch(OctreeGrowth& growth, const OctreePlace& place, const Samples& samples) {
  if (growth.branches.size() >= most_branches)
    throw InputError("octree: more than 2^24 branches; give fewer cells, or a larger tolerance");
  const int channels = int(growth.part.size());
  growth.part.insert(growth.part.end(), samples.part.begin(), samples.part.end());
  growth.phi.insert(growth.phi.end(), samples.phi.begin(), samples.phi.end());
  growth.branches.push_back({place, {}, channels, int(samples.part.size())});
  growth.branches.back().child.fill(-1);
  return int(growth.branches.size()) - 1;
}

/// Values at the 5 x 5 x 5 corners of the children of a branch's children, x fastest.
using FineNodes = std::array<double, 125>;
constexpr long unknown_fine_nodes = 125 - 27;

/// Values at the branch's own nodes are known; the others are evaluated.
FineNodes fine_nodes(const OctreeGrowth& growth, const OctreePlace& place, int channel) {
  FineNodes fine;
  const auto& [cx, cy, cz] = place.cell;
  const int part = growth.part[channel];
  for (int m = 0; m < 125; ++m) {
    const int x = m % 5, y = m / 5 % 5, z = m / 25;
    const bool is_known = x % 2 == 0 && y % 2 == 0 && z % 2 == 0;
    if (is_known) {
      fine[m] = growth.phi[channel][x / 2 + 3 * (y / 2) + 9 * (z / 2)];
      continue;
    }
    const std::array<int, 3> index = {4 * cx + x, 4 * cy + y, 4 * cz + z};
    fine[m] = sample(growth, part, lattice_position(growth.settings, place.level + 2, index));
  }
  return fine;
}

/// The fine nodes that child c would have as a branch.
BranchNodes<double> nodes_of_child(const FineNodes& fine, int c) {
  BranchNodes<double> nodes;
  const int first = 2 * (c & 1) + 10 * (c >> 1 & 1) + 50 * (c >> 2);
  for (int n = 0; n < 27; ++n) nodes[n] = fine[first + n % 3 + 5 * (n / 3 % 3) + 25 * (n / 9)];
  return nodes;
}

/// The bodies that may be nearest, or within reach, somewhere in the cell: a distance changes by at
/// most the distance moved.
Samples near_parts(const Samples& samples, const OctreeSettings& settings, int level) {
  const double half_width = half_diagonal(settings, level);
  double nearest = samples.phi[0][centre];
  for (const auto& phi : samples.phi) nearest = std::min(nearest, phi[centre]);
  Samples near;
  for (std::size_t k = 0; k < samples.part.size(); ++k)
    if (samples.phi[k][centre] - half_width <= std::max(nearest + half_width, settings.reach)) {
      near.part.push_back(samples.part[k]);
      near.phi.push_back(samples.phi[k]);
    }
  return near;
}

/// Is the interpolant of a leaf with these corners off at the other nodes by more than is allowed?
bool is_missed(const BranchNodes<double>& phi, const OctreeSettings& settings) {
  for (int n = 0; n < 27; ++n) {
    const double allowed =
        settings.tolerance + settings.beyond * std::max(0.0, std::abs(phi[n]) - settings.band);
    if (!(std::abs(corner_mean(phi, n) - phi[n]) <= allowed)) return true;
  }
  return false;
}

bool wants_split(const Samples& samples, const OctreeSettings& settings, int level) {
  for (std::size_t k = 0; k < samples.phi.size(); ++k) {
    const bool may_hold_surface =
        std::abs(samples.phi[k][centre]) <= half_diagonal(settings, level);
    if (level < settings.surface_depth && may_hold_surface) return true;
    if (needs_channel(samples.phi, k, settings.reach) && is_missed(samples.phi[k], settings))
      return true;
  }
  return false;
}

/// Samples of those children of a branch that are to be split; one without samples stays a leaf.
using SplitChildren = std::array<Samples, 8>;

SplitChildren split_children(const OctreeGrowth& growth, const GrowingBranch& branch) {
  SplitChildren split;
  const int level = branch.place.level + 1;
  if (level >= growth.settings.depth) return split;
  std::vector<FineNodes> fine;
  for (int k = branch.channels; k < branch.channels + branch.parts; ++k)
    fine.push_back(fine_nodes(growth, branch.place, k));
  for (int c = 0; c < 8; ++c) {
    Samples samples;
    for (int k = 0; k < branch.parts; ++k) {
      samples.part.push_back(growth.part[branch.channels + k]);
      samples.phi.push_back(nodes_of_child(fine[k], c));
    }
    samples = near_parts(samples, growth.settings, level);
    if (wants_split(samples, growth.settings, level)) split[c] = std::move(samples);
  }
  return split;
}

void add_children(OctreeGrowth& growth, std::size_t b, const SplitChildren& split) {
  const GrowingBranch branch = growth.branches[b];
  if (branch.place.level + 1 < growth.settings.depth)
    growth.evaluations += unknown_fine_nodes * branch.parts;
  for (int c = 0; c < 8; ++c)
    if (!split[c].part.empty())
      growth.branches[b].child[c] = add_branch(growth, child_place(branch.place, c), split[c]);
}

/// Splits the children of `count` branches. They are found at once and added in order.
void split_children(OctreeGrowth& growth, std::size_t first, std::size_t count, const Team& team) {
  std::vector<SplitChildren> split(count);
  for_each_index(team, Eigen::Index(count), [&](Eigen::Index k) {
    split[size_t(k)] = split_children(growth, growth.branches[first + size_t(k)]);
  });
  for (std::size_t k = 0; k < count; ++k) add_children(growth, first + k, split[k]);
}

int child_towards(const OctreePlace& place, int shift) {
  return (place.cell[0] >> shift & 1) | (place.cell[1] >> shift & 1) << 1 |
         (place.cell[2] >> shift & 1) << 2;
}

/// Splits leaves until there is a cell at this place.
void make_cell(OctreeGrowth& growth, const OctreePlace& place) {
  int b = 0;
  for (int shift = place.level - 1; shift > 0; --shift) {
    const int c = child_towards(place, shift);
    if (growth.branches[b].child[c] < 0) {
      const GrowingBranch branch = growth.branches[b];
      const auto first = growth.part.begin() + branch.channels;
      const std::vector<int> parts(first, first + branch.parts);
      const OctreePlace child = child_place(branch.place, c);
      const Samples samples =
          near_parts(take_samples(growth, parts, child), growth.settings, child.level);
      growth.branches[b].child[c] = add_branch(growth, child, samples);
    }
    b = growth.branches[b].child[c];
  }
}

/// Splits until the 26 cells around a branch are no wider than it. Its place is passed by value:
/// new branches may move all others.
void make_neighbours(OctreeGrowth& growth, OctreePlace place) {
  for (int d = 0; d < 27; ++d) {
    OctreePlace next = place;
    next.cell[0] += d % 3 - 1;
    next.cell[1] += d / 3 % 3 - 1;
    next.cell[2] += d / 9 - 1;
    const auto is_inside = [&](int i) { return i >= 0 && i < 1 << next.level; };
    if (std::all_of(next.cell.begin(), next.cell.end(), is_inside)) make_cell(growth, next);
  }
}

/// Not farther at any node, and so nowhere between them.
bool is_in_front(const BranchNodes<double>& one, const BranchNodes<double>& other) {
  for (std::size_t n = 0; n < one.size(); ++n)
    if (!(one[n] <= other[n])) return false;
  return true;
}

}  // namespace

bool needs_channel(const std::vector<BranchNodes<double>>& phi, std::size_t part, double reach) {
  const BranchNodes<double>& own = phi[part];
  if (std::ranges::any_of(own, [&](double value) { return value <= reach; })) return true;
  for (std::size_t other = 0; other < phi.size(); ++other)
    if (other != part && is_in_front(phi[other], own) && (other < part || phi[other] != own))
      return false;
  return true;
}

OctreeGrowth grow_octree(const std::vector<DistanceFunction>& bodies,
                         const OctreeSettings& settings, const Team& team) {
  OctreeGrowth growth{bodies, settings, {}, {}, {}, 0};
  std::vector<int> all(bodies.size());
  for (std::size_t k = 0; k < all.size(); ++k) all[k] = int(k);
  const OctreePlace cube{0, {0, 0, 0}};
  add_branch(growth, cube, near_parts(take_samples(growth, all, cube), settings, 0));
  for (std::size_t first = 0; first < growth.branches.size();) {
    const std::size_t count = std::min(batch, growth.branches.size() - first);
    split_children(growth, first, count, team);
    first += count;
  }
  return growth;
}

void balance(OctreeGrowth& growth) {
  for (int level = growth.settings.depth - 1; level > 0; --level)
    for (std::size_t b = 0; b < growth.branches.size(); ++b)
      if (growth.branches[b].place.level == level)
        make_neighbours(growth, growth.branches[b].place);
}

}  // namespace foldproof
