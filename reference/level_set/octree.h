// Adaptively sampled distance: an octree of trilinear cells, fine where the distance is curved and
// near, coarse elsewhere (BMF03 section 5.1, after Frisken et al. 2000); continuous where cells of
// two sizes meet.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include "reference/fast/team.h"
#include "reference/level_set/signed_distance.h"
#include "reference/types.h"

namespace foldproof {

using DistanceFunction = std::function<Distance(const Vector3&)>;

/// Treatment of a node in the middle of a coarser neighbour's edge or face.
enum class HangingNodes {
  constrained,  // it takes the neighbour's interpolant: phi is continuous
  free          // it keeps its own value: phi jumps there
};

/// Sampling density and error tolerances.
struct OctreeSettings {
  Vector3 corner;     // lowest corner of the covered cube [m]
  double width;       // of the cube [m]
  int depth;          // the finest cells are width / 2^depth wide
  int surface_depth;  // cells that may hold the surface are no wider than width / 2^surface_depth
  // within `band`, cells are split where the trilinear interpolant has a larger error [m]
  double tolerance;
  double band;    // of |phi| [m]
  double beyond;  // additional allowed error per distance beyond the band [1]
  double reach;   // unions: parts nearer than this are stored in addition to the nearest one [m]
  HangingNodes hanging;
};

/// Values at the 3 x 3 x 3 nodes of a branch, x fastest: its children's corners.
template <class T>
using BranchNodes = std::array<T, 27>;

/// A cell that is split into eight. Child c is at the upper half along x, y, z if its bits 0, 1, 2
/// are set.
struct OctreeBranch {
  int children;  // the first of its children that are branches; the others follow in the order of c
  int channels;  // the first of its channels
  unsigned char inner;  // bit c: child c is a branch, else it is a leaf
  unsigned char parts;  // number of its channels, at least one
};

/// Where the descent to a leaf begins: the deepest branch, down to start_level, that holds a
/// cell of that level.
struct OctreeStart {
  int branch, level;
};

/// For a union, each branch holds a channel for every part that is nearest at one of its nodes, or
/// nearer than the reach. Each channel is as smooth as its part, so the crease of the union is
/// placed correctly between nodes.
struct Octree {
  OctreeSettings settings;
  std::vector<OctreeBranch> branches;    // level by level; the first is the whole cube
  std::vector<int> part;                 // body of each channel
  std::vector<BranchNodes<double>> phi;  // of each channel [m]
  long evaluations = 0;                  // distance evaluations during the build
  int start_level = 0;  // the deepest level with no more cells than the tree has branches
  std::vector<OctreeStart> starts = {};  // of the 2^start_level cells along each axis, x fastest

  /// The union of all parts: the distance to the part that is nearest or entered deepest.
  Distance at(const Vector3& p) const;
};

/// Covers the union of bodies, which must lie inside the cube. Within the band the interpolation
/// error at the tested points (edge, face and cell midpoints) is at most the tolerance, unless the
/// cells there are the finest. Beyond the band, `beyond` times the distance is added. A constrained
/// node adds the error of its coarse neighbour. Neighbours, also across edges and corners, differ
/// by one level at most. Throws InputError: no bodies, a setting out of range, a body that reaches
/// the cube's boundary. Several threads of the team query the bodies at once; the bits are the same
/// for every team.
Octree make_octree(const std::vector<DistanceFunction>& bodies, const OctreeSettings& settings,
                   const Team& team = {});

/// Prepares a complete tree for queries: tabulates the levels down to start_level, because a
/// descent waits for memory at each level.
void index_descent_starts(Octree& tree);

/// The leaf that holds p, which lies in the cube.
struct OctreeLeaf {
  int branch, child;
  int level;      // its width is the cube's over 2^level
  Vector3 local;  // p in the leaf, 0 to 1 along each axis
};

OctreeLeaf leaf_at(const Octree& tree, const Vector3& p);

inline const Distance nowhere{std::numeric_limits<double>::infinity(), Vector3::Zero()};

/// Answer of a union at a point: the two parts that it is deepest in or nearest to.
struct NearestParts {
  Distance first = nowhere, second = nowhere;
  int first_part = -1, second_part = -1;  // -1: no second part is within reach
  int inside = 0;  // number of parts that contain the point; two or more: pinched
};

/// p anywhere; outside the cube, distances are measured from the surface point below the cube's
/// nearest point.
NearestParts nearest_parts(const Octree& tree, const Vector3& p);

/// A node of the union: its nearest part, and whether two or more parts contain it.
struct NodeFlags {
  int part;
  bool pinched;
};

/// Of the 27 nodes of a branch.
BranchNodes<NodeFlags> node_flags(const Octree& tree, int branch);

std::size_t leaves(const Octree& tree);
std::size_t bytes(const Octree& tree);  // memory of the tree

/// A solid sampled by an octree; copies share it.
struct OctreeSolid {
  std::shared_ptr<const Octree> tree;
  Distance at(const Vector3& p) const { return tree->at(p); }
};

}  // namespace foldproof
