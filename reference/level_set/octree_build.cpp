#include <algorithm>
#include <string>

#include "reference/level_set/octree.h"
#include "reference/level_set/octree_growth.h"

namespace foldproof {

namespace {

void require(bool is_met, const char* what) {
  if (!is_met) throw InputError(std::string("octree: ") + what);
}

void require_usable(const OctreeSettings& settings) {
  require(settings.width > 0, "the cube's width must be positive");
  require(settings.depth >= 1 && settings.depth <= 20, "the depth must be 1 to 20");
  require(settings.surface_depth >= 0 && settings.surface_depth <= settings.depth,
          "the surface's depth must be 0 to the depth");
  require(settings.tolerance > 0, "the tolerance must be positive");
  require(settings.band >= 0 && settings.beyond >= 0,
          "the band and what is allowed beyond it must not be negative");
  require(settings.reach >= 0, "the reach must not be negative");
}

/// Appends the branch to the tree, with the channels that it needs; its children are set later.
void append(Octree& tree, const OctreeGrowth& growth, const GrowingBranch& branch) {
  const auto first = growth.phi.begin() + branch.channels;
  const std::vector<BranchNodes<double>> phi(first, first + branch.parts);
  const int channels = int(tree.part.size());
  for (int k = 0; k < branch.parts; ++k)
    if (needs_channel(phi, k, growth.settings.reach)) {
      tree.part.push_back(growth.part[branch.channels + k]);
      tree.phi.push_back(phi[k]);
    }
  tree.branches.push_back(
      {0, channels, 0, static_cast<unsigned char>(int(tree.part.size()) - channels)});
}

/// The branches reordered: the children of each side by side, after the children of earlier
/// branches.
Octree laid_out(const OctreeGrowth& growth) {
  Octree tree{growth.settings, {}, {}, {}, growth.evaluations};
  std::vector<int> order = {0};
  append(tree, growth, growth.branches[0]);
  for (std::size_t b = 0; b < order.size(); ++b) {
    tree.branches[b].children = int(order.size());
    for (int c = 0; c < 8; ++c) {
      const int child = growth.branches[order[b]].child[c];
      if (child < 0) continue;
      tree.branches[b].inner |= static_cast<unsigned char>(1 << c);
      append(tree, growth, growth.branches[child]);
      order.push_back(child);
    }
  }
  tree.branches.shrink_to_fit();
  tree.part.shrink_to_fit();
  tree.phi.shrink_to_fit();
  index_descent_starts(tree);
  return tree;
}

bool is_on_boundary(const OctreePlace& place, int n) {
  const int last = 2 << place.level;
  const std::array<int, 3> node = {2 * place.cell[0] + n % 3, 2 * place.cell[1] + n / 3 % 3,
                                   2 * place.cell[2] + n / 9};
  return std::any_of(node.begin(), node.end(), [&](int i) { return i == 0 || i == last; });
}

void require_free_boundary(const Octree& tree, int branch, const OctreePlace& place) {
  const OctreeBranch& b = tree.branches[branch];
  for (int k = b.channels; k < b.channels + b.parts; ++k)
    for (int n = 0; n < 27; ++n)
      if (is_on_boundary(place, n) && !(tree.phi[k][n] > 0))
        throw InputError("octree: body " + std::to_string(tree.part[k]) +
                         " reaches the boundary of the cube; make the cube larger");
}

}  // namespace

Octree make_octree(const std::vector<DistanceFunction>& bodies, const OctreeSettings& settings,
                   const Team& team) {
  require(!bodies.empty() && bodies.size() < 256, "there must be 1 to 255 bodies");
  require_usable(settings);
  OctreeGrowth growth = grow_octree(bodies, settings, team);
  balance(growth);
  Octree tree = laid_out(growth);
  const std::vector<OctreePlace> places = branch_places(tree);
  for (std::size_t b = 0; b < places.size(); ++b) {
    require_free_boundary(tree, int(b), places[b]);
    if (settings.hanging == HangingNodes::free) continue;
    const std::uint32_t hanging = hanging_nodes(tree, places[b]);
    const OctreeBranch& branch = tree.branches[b];
    for (int k = branch.channels; k < branch.channels + branch.parts; ++k)
      constrain(hanging, tree.phi[k]);
  }
  return tree;
}

}  // namespace foldproof
