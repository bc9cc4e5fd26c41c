// The broad phase of cloth_pairs.h with its work counted.
#pragma once

#include "reference/filters/cloth_pairs.h"

namespace foldproof {

/// Pairs of features, and how many pairs of boxes the search compared to find them.
struct PairSearch {
  std::vector<FeaturePair> pairs;
  long box_tests = 0;
};

/// The pairs of near_pairs, with the work of finding them.
PairSearch counted_near_pairs(const ClothTree& cloth, const PerParticle3& x,
                              const PerParticle3& end, double margin,
                              const std::vector<char>& moved = {});

}  // namespace foldproof
