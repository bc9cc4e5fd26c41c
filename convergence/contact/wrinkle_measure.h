// Two numbers for wrinkles: how high they are, and how long.
#pragma once

#include <functional>
#include <vector>

#include "reference/types.h"

namespace foldproof {

/// Standard deviation of the values (N) at those i for which `chosen`; NaN if there is none.
double deviation_where(const PerParticle& values, const std::function<bool(Eigen::Index)>& chosen);

/// The wavelength [unit of spacing] at which samples so far apart have the largest Fourier
/// coefficient, a straight line having been taken out: length/k with k a whole number. NaN for
/// fewer than 8 samples, or if nothing is left.
double dominant_wavelength(std::vector<double> samples, double spacing);

}  // namespace foldproof
