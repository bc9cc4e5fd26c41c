// A simulated number beside the one that it should be, in the manner of ASME V&V 20 (2009): the
// difference against the uncertainties of both sides, which are kept apart.
#pragma once

#include <string>

#include "convergence/any_case/error_bar.h"
#include "verification/oracles/estimate.h"
#include "verification/verdict.h"

namespace foldproof {

/// All numbers in one unit.
struct Comparison {
  std::string quantity;      // in words
  double simulated = 0;      // S
  double numerical = 0;      // u_num, how far S may be from its own limit of fine meshes
  oracles::Estimate should;  // D; its uncertainty: an experiment's scatter, or an oracle's own
};

double difference(const Comparison& comparison);            // S - D
double combined_uncertainty(const Comparison& comparison);  // u: root of the sum of squares

enum class Agreement { agrees, differs, cannot_tell };

/// differs: |S - D| > u. agrees: |S - D| <= u, and u is no larger than the resolution asked for.
/// cannot_tell: u is larger than that, or a number is not finite.
Agreement agreement_of(const Comparison& comparison, double resolution);

/// "agrees within u", "differs by d +- u" or "cannot tell", with the numbers.
std::string words_of(const Comparison& comparison, double resolution);

/// The finest value of a ladder as simulated, with its error bar.
Comparison compare_ladder(const std::string& quantity, const Ladder& ladder,
                          const oracles::Estimate& should);

/// A table for comparisons in this unit, a row each.
Table no_comparisons(const std::string& unit);
void add_comparison(Table& table, const Comparison& comparison, double resolution);

/// Holds iff |S - D| + u <= resolution in all rows of the table: an agreement that rests on large
/// uncertainties is inconclusive, and a difference that is large and known fails.
Finding judge_comparisons(Table table, double resolution, std::string why_resolution,
                          std::string note);

/// The same for one comparison by itself, in the unit 1.
Finding judge_comparison(const Comparison& comparison, double resolution,
                         std::string why_resolution, std::string note);

}  // namespace foldproof
