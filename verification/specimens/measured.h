// Numbers measured case by case, judged by the worst of them.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "verification/oracles/estimate.h"
#include "verification/verdict.h"

namespace foldproof {

/// Numbers measured case by case: all are shown, the worst is judged.
class Measured {
 public:
  /// What is measured and in what unit.
  Measured(std::string quantity, std::string unit) : quantity_(std::move(quantity)), unit_(std::move(unit)) {}

  void see(const std::string& name, double value);
  void see(const std::string& name, const oracles::Estimate& value);

  /// The worst value, with the largest of the uncertainties, against the bound; NaN, which fails, if nothing
  /// was seen.
  Finding judged(double bound, const std::string& why_bound) const;

 private:
  std::string quantity_, unit_;
  std::vector<std::string> names_;
  std::vector<double> values_;
  Worst worst_, uncertainty_;
};

/// A Measured in multiples of epsilon times a scale.
Measured roundings_of(const std::string& scale);

/// The largest value with its sign; NaN if any is, or if there is none.
double signed_largest(const std::vector<double>& values);

}  // namespace foldproof
