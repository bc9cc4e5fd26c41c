// Which features of the cloth may come near each other: a tree of boxes, fitted anew
// to each motion.
#pragma once

#include <optional>
#include <vector>

#include "reference/filters/feature_pair.h"
#include "reference/mesh/box_tree.h"
#include "reference/mesh/triangle_mesh.h"
#include "reference/types.h"

namespace foldproof {

/// What a triangle answers for, so that each vertex and each edge is asked about once: of its
/// corners and its sides (k: from corner k to the next), those that belong to it.
struct OwnedFeatures {
  std::array<bool, 3> corner, side;
};

/// Boxes over the cloth's triangles. Which triangles share a box the rest shape decides, once.
struct ClothTree {
  std::vector<Triangle> triangles;  // M
  std::vector<OwnedFeatures> own;   // M
  BoxTree tree;                     // over the triangles
  double mean_edge;                 // at rest [m]
};

ClothTree make_cloth_tree(const TriangleMesh& mesh);

/// Pairs of features without a common particle whose boxes, over their straight way from x to `end`
/// and widened by margin/2 on all sides, overlap: all that come nearer than `margin` on their way
/// are among them. In an order that the tree alone fixes.
///   moved   N, or empty: pairs of which no particle is marked are left out
std::vector<FeaturePair> near_pairs(const ClothTree& cloth, const PerParticle3& x,
                                    const PerParticle3& end, double margin,
                                    const std::vector<char>& moved = {});

/// Pairs found by one search with a margin to spare. The boxes are the key: as long as particles
/// stay inside them, later searches only choose from these pairs.
struct PairCache {
  std::vector<Bounds> boxes;       // N: of the particles, widened by half that margin
  std::vector<FeaturePair> pairs;  // near_pairs of them
};

PairCache make_pair_cache(const ClothTree& cloth, const PerParticle3& x, double margin);

/// Is every particle of x, widened by margin/2, inside its box?
bool cache_is_valid(const PairCache& cache, const PerParticle3& x, double margin);

/// The pairs that near_pairs finds for the same cloth, in the same order; nothing if a particle
/// leaves its box on the way.
std::optional<std::vector<FeaturePair>> pairs_from_cache(const PairCache& cache,
                                                         const PerParticle3& x,
                                                         const PerParticle3& end, double margin,
                                                         const std::vector<char>& moved = {});

}  // namespace foldproof
