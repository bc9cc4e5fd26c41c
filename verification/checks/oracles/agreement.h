// Whether two oracles that share nothing agree as closely as both promise.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "verification/oracles/estimate.h"
#include "verification/verdict.h"

namespace foldproof {

/// For answers of two roads to the same numbers, a row a point: each answer comes with how far the
/// truth may lie from it.
Table no_answers();

void compare(Table& answers, const std::string& point, const oracles::Estimate& one,
             const oracles::Estimate& other);

/// Of the numbers of one answer the pair that is furthest apart, by its uncertainty.
void compare_worst(Table& answers, const std::string& point,
                   const std::vector<std::pair<oracles::Estimate, oracles::Estimate>>& pairs);

/// Answers that are whole: a count, yes or no. They agree or they do not.
void compare_exact(Table& answers, const std::string& point, double one, double other);

/// The worst |one - other| over the sum of their uncertainties, against 1; an answer that is exact
/// on both sides counts 0 or infinity. NaN, which fails, if fewer than two points were compared.
Finding judged_agreement(const Table& answers);

/// The largest uncertainty over the size of its answer (of the larger answer, or of 1 where both
/// are smaller) [1].
double largest_uncertainty(const Table& answers);

}  // namespace foldproof
