#include "reference/level_set/octree.h"

#include <algorithm>
#include <cmath>

#include "reference/level_set/octree_nodes.h"

namespace foldproof {

namespace {

Vector3 clamp_to_cube(const OctreeSettings& cube, const Vector3& p) {
  return p.cwiseMax(cube.corner).cwiseMin(cube.corner + Vector3::Constant(cube.width));
}

/// phi and N of an interpolant.
Distance distance_of(const Trilinear& at) {
  const double length = at.slope.norm();
  return {at.value, length > 0 ? Vector3(at.slope / length) : Vector3::UnitZ()};
}

/// phi and N of the channel in the leaf.
Distance distance_in(const Octree& tree, int channel, const OctreeLeaf& leaf) {
  return distance_of(trilinear(tree.phi[channel], leaf.child, leaf.local));
}

/// The distance of p from the surface point q - phi N, where q is the nearest point of the cube.
Distance beyond_cube(const Distance& at_q, const Vector3& q, const Vector3& p) {
  const Vector3 away = p - (q - at_q.phi * at_q.normal);
  const double phi = away.norm();
  return {phi, phi > 0 ? Vector3(away / phi) : at_q.normal};
}

void see_part(NearestParts& at, const Distance& distance, int part) {
  if (distance.phi < 0) ++at.inside;
  if (at.first_part < 0 || distance.phi < at.first.phi) {
    at.second = at.first;
    at.second_part = at.first_part;
    at.first = distance;
    at.first_part = part;
  } else if (distance.phi < at.second.phi) {
    at.second = distance;
    at.second_part = part;
  }
}

}  // namespace

OctreeLeaf leaf_at(const Octree& tree, const Vector3& p) {
  const OctreeSettings& cube = tree.settings;
  const int cells = 1 << cube.depth;
  const Vector3 scaled = (p - cube.corner) * (1 / cube.width);
  std::array<int, 3> finest;
  for (int axis = 0; axis < 3; ++axis) {
    // for a NaN any cell will do: the interpolated value is NaN
    const double place = scaled[axis] * cells;
    finest[axis] = place >= cells ? cells - 1 : place > 0 ? int(place) : 0;
  }
  const auto& [x, y, z] = finest;
  const int first = tree.start_level, drop = cube.depth - first;
  const OctreeStart start =
      tree.starts[std::size_t(((z >> drop) << first | y >> drop) << first | x >> drop)];
  for (int b = start.branch, level = start.level + 1;; ++level) {
    const int width = cells >> level;  // of the branch's children, in finest cells
    const int c = int((x & width) != 0) | int((y & width) != 0) << 1 | int((z & width) != 0) << 2;
    const OctreeBranch& branch = tree.branches[b];
    if (branch.inner >> c & 1) {
      b = inner_child(branch, c);
      continue;
    }
    OctreeLeaf leaf{b, c, level, {}};
    for (int axis = 0; axis < 3; ++axis)
      leaf.local[axis] =
          scaled[axis] * double(1 << level) - double(finest[axis] >> (cube.depth - level));
    return leaf;
  }
}

Distance Octree::at(const Vector3& p) const {
  const Vector3 q = clamp_to_cube(settings, p);
  const OctreeLeaf leaf = leaf_at(*this, q);
  const OctreeBranch& branch = branches[leaf.branch];
  Trilinear nearest = trilinear(phi[branch.channels], leaf.child, leaf.local);
  for (int k = 1; k < branch.parts; ++k) {
    const Trilinear other = trilinear(phi[branch.channels + k], leaf.child, leaf.local);
    if (other.value < nearest.value) nearest = other;
  }
  return q == p ? distance_of(nearest) : beyond_cube(distance_of(nearest), q, p);
}

NearestParts nearest_parts(const Octree& tree, const Vector3& p) {
  const Vector3 q = clamp_to_cube(tree.settings, p);
  const OctreeLeaf leaf = leaf_at(tree, q);
  const OctreeBranch& branch = tree.branches[leaf.branch];
  NearestParts at;
  for (int k = branch.channels; k < branch.channels + branch.parts; ++k) {
    const Distance distance = distance_in(tree, k, leaf);
    see_part(at, q == p ? distance : beyond_cube(distance, q, p), tree.part[k]);
  }
  return at;
}

BranchNodes<NodeFlags> node_flags(const Octree& tree, int b) {
  const OctreeBranch& branch = tree.branches[b];
  BranchNodes<NodeFlags> flags;
  for (int n = 0; n < 27; ++n) {
    int nearest = branch.channels, inside = 0;
    for (int k = branch.channels; k < branch.channels + branch.parts; ++k) {
      if (tree.phi[k][n] < tree.phi[nearest][n]) nearest = k;
      if (tree.phi[k][n] < 0) ++inside;
    }
    flags[n] = {tree.part[nearest], inside >= 2};
  }
  return flags;
}

std::size_t leaves(const Octree& tree) { return 7 * tree.branches.size() + 1; }

std::size_t bytes(const Octree& tree) {
  return sizeof(Octree) + tree.branches.size() * sizeof(OctreeBranch) +
         tree.part.size() * sizeof(int) + tree.phi.size() * sizeof(BranchNodes<double>) +
         tree.starts.size() * sizeof(OctreeStart);
}

void index_descent_starts(Octree& tree) {
  tree.start_level = 0;
  while (std::size_t(8) << 3 * tree.start_level <= tree.branches.size()) ++tree.start_level;
  const int last = tree.start_level, cells = 1 << last;
  tree.starts.assign(std::size_t(cells * cells * cells), {0, 0});
  const std::vector<OctreePlace> places = branch_places(tree);
  for (std::size_t b = 0; b < places.size() && places[b].level <= last; ++b) {  // level by level
    const int width = 1 << (last - places[b].level);
    const auto& [x, y, z] = places[b].cell;
    for (int k = 0; k < width * width * width; ++k) {
      const int i = x * width + k % width, j = y * width + k / width % width,
                l = z * width + k / width / width;
      tree.starts[std::size_t((l * cells + j) * cells + i)] = {int(b), places[b].level};
    }
  }
}

Vector3 lattice_position(const OctreeSettings& settings, int level,
                         const std::array<int, 3>& index) {
  const Vector3 node(index[0], index[1], index[2]);
  return settings.corner + settings.width * (node / double(1 << level));
}

Vector3 node_position(const OctreeSettings& settings, const OctreePlace& place, int n) {
  const auto& [x, y, z] = place.cell;
  return lattice_position(settings, place.level + 1,
                          {2 * x + n % 3, 2 * y + n / 3 % 3, 2 * z + n / 9});
}

OctreePlace child_place(const OctreePlace& place, int c) {
  return {place.level + 1,
          {2 * place.cell[0] + (c & 1), 2 * place.cell[1] + (c >> 1 & 1),
           2 * place.cell[2] + (c >> 2)}};
}

std::vector<OctreePlace> branch_places(const Octree& tree) {
  std::vector<OctreePlace> places(tree.branches.size(), {0, {0, 0, 0}});
  for (std::size_t b = 0; b < places.size(); ++b)
    for (int c = 0; c < 8; ++c)
      if (tree.branches[b].inner >> c & 1)
        places[inner_child(tree.branches[b], c)] = child_place(places[b], c);
  return places;
}

}  // namespace foldproof
