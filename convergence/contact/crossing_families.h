// Questions to ask of a test for crossings: features that move in straight lines between points of
// small whole coordinates, so that no double is rounded and the answer can be known exactly.
#pragma once

#include <string>
#include <vector>

#include "reference/filters/approach.h"
#include "verification/oracles/exact_crossing_times.h"
#include "verification/specimens/random.h"

namespace foldproof {

struct CrossingQuery {
  PairKind kind;
  Corners4 x, displacement;  // m
};

oracles::Features features_of(PairKind kind);

/// Does it meet, decided without rounding? And before the time `end` of the motion, 0 to 1?
bool meets_exactly(const CrossingQuery& query);
bool meets_exactly_before(const CrossingQuery& query, double end);

/// A kind of question.
struct CrossingFamily {
  std::string name;
  CrossingQuery (*make)(Random& random, PairKind kind);
};

/// All eight points anywhere.
CrossingQuery random_query(Random& random, PairKind kind);

/// In each of them something coincides that is apart at random.
const std::vector<CrossingFamily>& degenerate_families();

/// The same a sixteenth as large, a thousand units from the origin; still without rounding.
CrossingQuery far_away(const CrossingQuery& query);

}  // namespace foldproof
