// Broad phase: which features of the cloth may come near each other, from a box tree refitted
// to each motion.
#pragma once

#include <optional>
#include <vector>

#include "reference/fast/team.h"
#include "reference/filters/feature_pair.h"
#include "reference/mesh/box_tree.h"
#include "reference/mesh/triangle_mesh.h"
#include "reference/types.h"

namespace foldproof {

/// The features that a triangle owns, so that each vertex and each edge is tested once: its owned
/// corners and sides (k: from corner k to the next).
struct OwnedFeatures {
  std::array<bool, 3> corner, side;
};

/// Boxes over the cloth's triangles. The rest shape determines once which triangles share a box.
struct ClothTree {
  std::vector<Triangle> triangles;  // M
  std::vector<OwnedFeatures> own;   // M
  BoxTree tree;                     // over the triangles
  double mean_edge;                 // at rest [m]
  Team team = {};                   // searches run on it
};

ClothTree make_cloth_tree(const TriangleMesh& mesh);

/// Pairs of features without a common particle whose boxes overlap. Boxes cover the straight path
/// from x to `end`, widened by margin/2 on all sides, so all pairs that come nearer than `margin`
/// are included. The order depends only on the tree.
///   moved   N, or empty: pairs without a marked particle are left out
std::vector<FeaturePair> near_pairs(const ClothTree& cloth, const PerParticle3& x,
                                    const PerParticle3& end, double margin,
                                    const std::vector<char>& moved = {});

/// Pairs nearer than `distance` [m] at x.
std::vector<FeaturePair> touching_pairs(const ClothTree& cloth, const PerParticle3& x,
                                        double distance);

/// Pairs found by one search with an enlarged margin: while the particles stay inside these boxes,
/// later searches only select from these pairs.
struct PairsAhead {
  std::vector<Bounds> boxes;       // N: one per particle, widened by half that margin
  std::vector<FeaturePair> pairs;  // near_pairs of these boxes
  Team team = {};                  // selection runs on it
  long box_tests = 0;              // that the search took
  double spare = 0;                // of the margin, for the coming steps [m]
  long steps = 0;                  // that asked for it
};

/// Is a particle of the pair marked?
///   moved   N, or empty: all are
bool has_moved_particle(const FeaturePair& pair, const std::vector<char>& moved);

PairsAhead pairs_ahead(const ClothTree& cloth, const PerParticle3& x, double margin);

/// Is every particle of x, widened by margin/2, inside its box?
bool is_inside(const PairsAhead& ahead, const PerParticle3& x, double margin);

/// The pairs that near_pairs finds for the same cloth, in the same order; nullopt if a particle
/// leaves its box on the way.
std::optional<std::vector<FeaturePair>> pairs_among(const PairsAhead& ahead, const PerParticle3& x,
                                                    const PerParticle3& end, double margin,
                                                    const std::vector<char>& moved = {});

}  // namespace foldproof
