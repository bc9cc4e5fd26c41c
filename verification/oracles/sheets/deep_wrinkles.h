// Wrinkles of a stretched plate far beyond their onset: their height.
#pragma once

#include <span>
#include <vector>

#include "verification/oracles/estimate.h"

namespace foldproof::oracles {

/// A plate as in stretched_wrinkles.h with Young's modulus times thickness Y, whose width is
/// shortened by the fraction Delta beyond the contraction from tension. Every section is shortened
/// equally. Where the plate folds as w = X(s) cos(k y), k^2 X^2/4 of Delta is folded away, and the
/// rest is compressed:
///   D (X'''' - 2 k^2 X'' + k^4 X) - T X'' - k^2 Y (Delta - k^2 X^2/4) X = 0.
/// With X = (2/k) Delta^(1/2) f and lengths over L, three numbers remain.
struct DeepWrinkles {
  double reach;        // (D/T)^(1/2)/L; at least 0.003
  double wavelength;   // 2 pi/k over L
  double compression;  // Y Delta/T
};

struct DeepWrinkleHeight {
  Estimate middle;              // f halfway between the clamps
  double bend = 0;              // f'' there
  std::vector<double> heights;  // f at the requested places, from 0 to 1
};

/// f by a series sum c_j (1 - cos(2 pi j s)) of least energy, followed from small heights up. No
/// height if the plate stays flat.
DeepWrinkleHeight deep_wrinkles_by_series(const DeepWrinkles& wrinkles,
                                          std::span<const double> places);

/// f in the middle, by shooting from there to a clamp, started near `guess`; reach >= 0.08.
Estimate deep_wrinkles_by_shooting(const DeepWrinkles& wrinkles, const DeepWrinkleHeight& guess);

/// f = 2^(1/2): a sine along the length whose mean excess length is Delta. f = 1: every section
/// folds away all of its prescribed shortening. With X in wavelengths,
///   X = (2^(1/2)/pi) Delta^(1/2) or X = (1/pi) Delta^(1/2).
constexpr double folded_in_the_mean = 1.4142135623730951;
constexpr double folded_in_each_section = 1;

}  // namespace foldproof::oracles
