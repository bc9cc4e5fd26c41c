// An octree while it grows: every body that may matter is sampled at every node, and children stand
// where they were made.
#pragma once

#include <array>
#include <vector>

#include "reference/level_set/octree.h"
#include "reference/level_set/octree_nodes.h"

namespace foldproof {

struct GrowingBranch {
  OctreePlace place;
  std::array<int, 8> child;  // index of the child's branch; -1: a leaf
  int channels, parts;       // the first of its channels, and how many
};

struct OctreeGrowth {
  const std::vector<DistanceFunction>& bodies;
  const OctreeSettings& settings;
  std::vector<GrowingBranch> branches;
  std::vector<int> part;                 // of each channel
  std::vector<BranchNodes<double>> phi;  // of each channel, not constrained [m]
  long evaluations = 0;
};

/// Splits cells, from the whole cube down, as long as the settings ask for it.
OctreeGrowth grow_octree(const std::vector<DistanceFunction>& bodies,
                         const OctreeSettings& settings);

/// Splits leaves that touch, be it at a corner, cells more than one level finer.
void balance(OctreeGrowth& growth);

/// Is a part worth a channel: nearer than the reach at one of the nodes, or not behind one and the
/// same other part at all of them? Behind it at the nodes it is so between them, where phi is
/// interpolated, and on neighbours' faces too.
bool needs_channel(const std::vector<BranchNodes<double>>& phi, std::size_t part, double reach);

}  // namespace foldproof
