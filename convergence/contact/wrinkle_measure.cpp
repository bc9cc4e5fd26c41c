#include "convergence/contact/wrinkle_measure.h"

#include <cmath>
#include <complex>
#include <limits>

namespace foldproof {

namespace {

/// Takes the best straight line out.
void flatten(std::vector<double>& samples) {
  const double n = double(samples.size()), middle = (n - 1) / 2;
  double mean = 0, slope = 0;
  for (size_t k = 0; k < samples.size(); ++k) {
    mean += samples[k] / n;
    slope += samples[k] * (double(k) - middle);
  }
  slope /= n * (n * n - 1) / 12;  // sum of (k - middle)^2
  for (size_t k = 0; k < samples.size(); ++k) samples[k] -= mean + slope * (double(k) - middle);
}

/// |sum_n s_n exp(-2 pi i k n/N)|
double coefficient(const std::vector<double>& samples, size_t k) {
  std::complex<double> sum = 0;
  const double turn = -2 * pi * double(k) / double(samples.size());
  for (size_t n = 0; n < samples.size(); ++n) sum += samples[n] * std::polar(1.0, turn * double(n));
  return std::abs(sum);
}

}  // namespace

double deviation_where(const PerParticle& values, const std::function<bool(Eigen::Index)>& chosen) {
  double count = 0, mean = 0, squares = 0;  // Welford: no cancellation
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    if (!chosen(i)) continue;
    const double off = values[i] - mean;
    mean += off / ++count;
    squares += off * (values[i] - mean);
  }
  return std::sqrt(squares / count);
}

double dominant_wavelength(std::vector<double> samples, double spacing) {
  if (samples.size() < 8) return std::numeric_limits<double>::quiet_NaN();
  flatten(samples);
  size_t largest = 0;
  double most = 0;
  for (size_t k = 1; k <= samples.size() / 2; ++k) {
    const double size = coefficient(samples, k);
    if (size > most) {
      most = size;
      largest = k;
    }
  }
  const double length = spacing * double(samples.size());
  return largest > 0 ? length / double(largest) : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace foldproof
