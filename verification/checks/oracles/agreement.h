// Agreement of two independent oracles within their uncertainties.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "verification/oracles/estimate.h"
#include "verification/verdict.h"

namespace foldproof {

/// A table for two independent computations of the same numbers, one point per row; each answer has
/// its uncertainty.
Table no_answers();

void compare(Table& answers, const std::string& point, const oracles::Estimate& one,
             const oracles::Estimate& other);

/// Adds the pair of numbers that differ most, relative to their uncertainty.
void compare_worst(Table& answers, const std::string& point,
                   const std::vector<std::pair<oracles::Estimate, oracles::Estimate>>& pairs);

/// For exact answers (counts, yes or no): they either agree or not.
void compare_exact(Table& answers, const std::string& point, double one, double other);

/// The worst |one - other| over the sum of their uncertainties, against 1; if both answers are
/// exact the ratio is 0 or infinity. NaN, which fails, if fewer than two points were compared.
Finding judged_agreement(const Table& answers);

/// The largest uncertainty over the size of its answer (of the larger answer, or of 1 where both
/// are smaller) [1].
double largest_uncertainty(const Table& answers);

}  // namespace foldproof
