#include "reference/level_set/narrow_band.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "reference/fast/loops.h"

namespace foldproof {

namespace {

constexpr int block = 4;  // nodes along the side of the blocks that are kept or left out as one

/// A node in the band.
struct Seed {
  long node;   // its index in the lattice
  double phi;  // m
};

/// May any node of the block that begins at `first` be closer than `width` [m]?
bool is_near(const MeshDistance& mesh, const Lattice& lattice, const Node& first, double width) {
  const Vector3 half = Vector3::Constant(0.5 * (block - 1) * lattice.spacing);
  return nearest_feature(mesh, lattice.position(first) + half, width + half.norm()).triangle >= 0;
}

/// Adds the nodes of a row of the block, from `node` on. A node is at most one spacing farther away
/// than the one before it, which shortens the search.
void add_row(const MeshDistance& mesh, const Lattice& lattice, Node node, double width,
             std::vector<Seed>& seeds) {
  double bound = width;
  const int end = std::min(node[0] + block, lattice.nodes[0]);
  for (; node[0] < end; ++node[0]) {
    const Vector3 p = lattice.position(node);
    const NearestFeature nearest = nearest_feature(mesh, p, bound);
    if (nearest.triangle < 0) continue;  // the bound was the width
    const double phi = signed_distance(mesh, nearest, p).phi;
    bound = std::min(width, std::abs(phi) + 1.001 * lattice.spacing);
    seeds.push_back({lattice.index(node), phi});
  }
}

void add_block(const MeshDistance& mesh, const Lattice& lattice, const Node& first, double width,
               std::vector<Seed>& seeds) {
  for (int k = first[2]; k < std::min(first[2] + block, lattice.nodes[2]); ++k)
    for (int j = first[1]; j < std::min(first[1] + block, lattice.nodes[1]); ++j)
      add_row(mesh, lattice, {first[0], j, k}, width, seeds);
}

/// The first nodes of all blocks that may hold a node of the band, in order. They are found first
/// because most blocks hold none: the rest can then be divided evenly.
std::vector<Node> near_blocks(const MeshDistance& mesh, const Lattice& lattice, double width,
                              const Team& team) {
  Node count;  // of blocks along each axis
  for (int axis = 0; axis < 3; ++axis) count[axis] = (lattice.nodes[axis] + block - 1) / block;
  return found_in_order<Node>(
      team, Eigen::Index(count[0]) * count[1] * count[2],
      [&](Eigen::Index begin, Eigen::Index blocks, std::vector<Node>& found) {
        for (Eigen::Index b = begin; b < begin + blocks; ++b) {
          const Node first = {block * int(b % count[0]), block * int(b / count[0] % count[1]),
                              block * int(b / count[0] / count[1])};
          if (is_near(mesh, lattice, first, width)) found.push_back(first);
        }
      });
}

}  // namespace

Seeds narrow_band(const MeshDistance& mesh, const Lattice& lattice, double cells,
                  const Team& team) {
  if (!(cells >= 1))
    throw InputError("narrow_band: " + std::to_string(cells) + " cells; give at least 1");
  // slightly wider than requested, so that neighbours of a node on the surface are in a band of one
  // cell
  const double width = (1 + 1e-12) * cells * lattice.spacing;
  const std::vector<Node> blocks = near_blocks(mesh, lattice, width, team);
  const auto add_blocks = [&](Eigen::Index first, Eigen::Index count, std::vector<Seed>& found) {
    for (Eigen::Index b = first; b < first + count; ++b)
      add_block(mesh, lattice, blocks[size_t(b)], width, found);
  };
  Seeds seeds;
  for (const Seed& seed : found_in_order<Seed>(team, Eigen::Index(blocks.size()), add_blocks)) {
    seeds.nodes.push_back(seed.node);
    seeds.phi.push_back(seed.phi);
  }
  return seeds;
}

}  // namespace foldproof
