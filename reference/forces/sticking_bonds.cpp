// Breaks and forms the bonds of sticking.
#include <algorithm>
#include <set>
#include <tuple>
#include <utility>

#include "reference/forces/degenerate.h"
#include "reference/forces/sticking.h"
#include "reference/mesh/box_tree.h"
#include "reference/mesh/nearest_point.h"

namespace foldproof {

namespace {

constexpr int leaf_size = 4;

bool is_active(const StickyPatch& patch, double t) { return t >= patch.from && t < patch.until; }

Corners3 corners_at(const PerParticle3& x, const Triangle& triangle) {
  return {x.col(triangle[0]), x.col(triangle[1]), x.col(triangle[2])};
}

/// A patch at its current position, for queries of nearby triangles.
struct PatchNow {
  const StickyPatch& patch;
  int number;
  const PerParticle3& x;  // of the corners
};

/// A bond to the triangle if the particle at p is near it.
void add_bond_if_near(const PatchNow& now, int triangle, int particle, const Vector3& p,
                      std::vector<Bond>& bonds) {
  const Triangle& names = now.patch.triangles[size_t(triangle)];
  if (!now.patch.place && std::ranges::find(names, particle) != names.end()) return;
  const Corners3 corners = corners_at(now.x, names);
  const double distance = (nearest_on_triangle(corners, p).point - p).norm();
  if (!(distance <= now.patch.near)) return;
  const Vector3 place = local_place(corners, p);
  if (!place.allFinite())
    throw DegenerateElement("a triangle of sticky '" + now.patch.name + "' has no area",
                            {particle});
  bonds.push_back({now.number, triangle, particle, place});
}

void add_bonds_of(const PatchNow& now, const BoxTree& tree, int particle, const Vector3& p,
                  std::vector<Bond>& bonds) {
  std::vector<int> waiting = {0};
  while (!waiting.empty()) {
    const int at = waiting.back();
    waiting.pop_back();
    const BoxNode& node = tree.nodes[size_t(at)];
    if (!(node.bounds.exteriorDistance(p) <= now.patch.near)) continue;
    if (node.right >= 0) {
      waiting.insert(waiting.end(), {node.right, at + 1});
      continue;
    }
    for (int k = node.first; k < node.first + node.count; ++k)
      add_bond_if_near(now, tree.order[size_t(k)], particle, p, bonds);
  }
}

using Stuck = std::set<std::pair<int, int>>;  // patch and particle

/// New bonds of all particles that may stick to the patch but have no bond to it.
void add_new_bonds(const PatchNow& now, const State& s, const Stuck& stuck,
                   std::vector<Bond>& bonds) {
  Bounds reach = bounds_of(now.x);
  reach.min().array() -= now.patch.near;
  reach.max().array() += now.patch.near;
  std::vector<int> candidates;
  for (const int particle : now.patch.particles)
    if (reach.contains(s.x.col(particle)) && !stuck.contains({now.number, particle}))
      candidates.push_back(particle);
  if (candidates.empty()) return;
  const BoxTree tree = make_box_tree(triangle_bounds(now.x, now.patch.triangles), leaf_size);
  for (const int particle : candidates) add_bonds_of(now, tree, particle, s.x.col(particle), bonds);
}

}  // namespace

void Sticking::update_bonds(State& s) const {
  std::vector<Bond> bonds;
  Stuck stuck;
  for (const StickyTarget& target : targets_at(s)) {
    const StickyPatch& patch = patches[size_t(target.patch)];
    if (!is_active(patch, s.time) || !(target.distance <= patch.far)) continue;
    stuck.insert({target.patch, target.particle});
    const auto first = s.bonds.begin() + std::ptrdiff_t(target.first);
    bonds.insert(bonds.end(), first, first + std::ptrdiff_t(target.count));
  }
  for (size_t k = 0; k < patches.size(); ++k) {
    const StickyPatch& patch = patches.at(k);
    if (!is_active(patch, s.time)) continue;
    const PerParticle3 surface = patch.place ? patch.place(s.time) : PerParticle3();
    add_new_bonds({patch, int(k), patch.place ? surface : s.x}, s, stuck, bonds);
  }
  std::ranges::sort(bonds, {},
                    [](const Bond& b) { return std::tuple(b.patch, b.particle, b.triangle); });
  s.bonds = std::move(bonds);
}

}  // namespace foldproof
