// An octree under construction: every body that may matter is sampled at every node, and children
// are stored in order of creation.
#pragma once

#include <array>
#include <vector>

#include "reference/fast/team.h"
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

/// Splits cells, from the whole cube down, until the settings are met; all threads of the team
/// query the bodies at once.
OctreeGrowth grow_octree(const std::vector<DistanceFunction>& bodies,
                         const OctreeSettings& settings, const Team& team);

/// Splits leaves that touch cells more than one level finer, even only at a corner.
void balance(OctreeGrowth& growth);

/// True if a part needs a channel: it is nearer than the reach at one of the nodes, or no single
/// other part is nearer at all of them. A part that is farther at all nodes is also farther between
/// them, where phi is interpolated, and on neighbours' faces.
bool needs_channel(const std::vector<BranchNodes<double>>& phi, std::size_t part, double reach);

}  // namespace foldproof
