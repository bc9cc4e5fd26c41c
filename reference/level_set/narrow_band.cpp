#include "reference/level_set/narrow_band.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace foldproof {

namespace {

constexpr int block = 4;  // nodes along the side of the blocks that are kept or left out as one

/// Is any node of the block that begins at `first` possibly closer than `width` [m]?
bool is_near(const MeshDistance& mesh, const Lattice& lattice, const Node& first, double width) {
  const Vector3 half = Vector3::Constant(0.5 * (block - 1) * lattice.spacing);
  return nearest_feature(mesh, lattice.position(first) + half, width + half.norm()).triangle >= 0;
}

/// Adds the nodes of a row of the block, from `node` on. A node is at most one spacing farther away
/// than the one before it, which shortens the search.
void add_row(const MeshDistance& mesh, const Lattice& lattice, Node node, double width,
             Seeds& seeds) {
  double bound = width;
  const int end = std::min(node[0] + block, lattice.nodes[0]);
  for (; node[0] < end; ++node[0]) {
    const Vector3 p = lattice.position(node);
    const NearestFeature nearest = nearest_feature(mesh, p, bound);
    if (nearest.triangle < 0) continue;  // the bound is the width
    const double phi = signed_distance(mesh, nearest, p).phi;
    bound = std::min(width, std::abs(phi) + 1.001 * lattice.spacing);
    seeds.nodes.push_back(lattice.index(node));
    seeds.phi.push_back(phi);
  }
}

void add_block(const MeshDistance& mesh, const Lattice& lattice, const Node& first, double width,
               Seeds& seeds) {
  if (!is_near(mesh, lattice, first, width)) return;
  for (int k = first[2]; k < std::min(first[2] + block, lattice.nodes[2]); ++k)
    for (int j = first[1]; j < std::min(first[1] + block, lattice.nodes[1]); ++j)
      add_row(mesh, lattice, {first[0], j, k}, width, seeds);
}

}  // namespace

Seeds narrow_band(const MeshDistance& mesh, const Lattice& lattice, double cells) {
  if (!(cells >= 1))
    throw InputError("narrow_band: " + std::to_string(cells) + " cells; give at least 1");
  // a little more than asked for, so that neighbours of a node on the surface are in a
  // band of one cell
  const double width = (1 + 1e-12) * cells * lattice.spacing;
  Seeds seeds;
  Node first;
  for (first[2] = 0; first[2] < lattice.nodes[2]; first[2] += block)
    for (first[1] = 0; first[1] < lattice.nodes[1]; first[1] += block)
      for (first[0] = 0; first[0] < lattice.nodes[0]; first[0] += block)
        add_block(mesh, lattice, first, width, seeds);
  return seeds;
}

}  // namespace foldproof
