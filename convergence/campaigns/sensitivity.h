// Sensitivity from samples that are there: which parameter a quantity's scatter comes from.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace foldproof {

/// The first-order index of a parameter: the share of the quantity's variance that goes if the
/// parameter were known (Sobol 1993).
struct FirstOrderIndex {
  double index;  // [1]; NaN for fewer than 40 samples, or where y is the same in all
  double error;  // its standard error, by leaving out one of 20 interleaved groups of samples
  size_t samples;
  size_t bins;  // of equally many samples
};

/// Kelley's epsilon squared (1935): the correlation ratio of y over bins of x, without the part
/// that chance gives it. It needs no samples of its own kind: bins of equally many samples are
/// unions of the strata of a Latin hypercube. What varies within a bin counts as unexplained, for a
/// straight line a share of 1/bins^2.
///   x, y   of the samples; those where y is NaN are left out
FirstOrderIndex first_order_index(std::span<const double> x, std::span<const double> y);

}  // namespace foldproof
