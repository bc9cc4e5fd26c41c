// Oracles checked by oracles: agreement of two independent computations of the same numbers,
// within their uncertainties, at several parameter points.
#pragma once

#include "verification/oracles/estimate.h"
#include "verification/specimens/check.h"

namespace foldproof {

using Pairs = std::vector<std::pair<oracles::Estimate, oracles::Estimate>>;

/// The answers of both methods, one point per row; each answer has its uncertainty.
class Answers {
 public:
  void compare(const std::string& point, const oracles::Estimate& one,
               const oracles::Estimate& other);
  /// Adds the pair of numbers that differ most, relative to their uncertainty.
  void compare_worst(const std::string& point, const Pairs& pairs);
  /// For exact answers (counts, yes or no): they either agree or not.
  void compare_exact(const std::string& point, double one, double other);

  /// The worst |one - other| over the sum of their uncertainties, against 1; if both answers are
  /// exact the ratio is 0 or infinity. NaN, which fails, if fewer than two points were compared.
  Finding judged_agreement() const;

  /// The largest uncertainty over the size of its answer (of the larger answer, or of 1 where both
  /// are smaller) [1].
  double largest_uncertainty() const;

 private:
  Table table_{"point; one way; other way; uncertainty of both; apart, of that [1]"};
};

/// A check that two methods agree.
struct Comparison {
  const char *name, *claim;
  void (*compare)(Answers&);
  double allowed = 1e-5;  // uncertainty of an answer over its size [1]
};

std::vector<Comparison> force_comparisons();     // force_oracles.cpp
std::vector<Comparison> motion_comparisons();    // motion_oracles.cpp
std::vector<Comparison> static_comparisons();    // static_oracles.cpp
std::vector<Comparison> strip_comparisons();     // strip_oracles.cpp
std::vector<Comparison> geometry_comparisons();  // geometry_oracles.cpp

}  // namespace foldproof
