// Rows of parameters.
#pragma once

#include <cmath>
#include <vector>

namespace foldproof {

/// `count` >= 2 values from low to high, all in the same ratio to the next; 0 < low < high.
inline std::vector<double> geometric_range(double low, double high, int count) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i)
    values.push_back(low * std::pow(high / low, double(i) / (count - 1)));
  return values;
}

/// `count` >= 2 values from low to high, all as far from the next.
inline std::vector<double> linear_range(double low, double high, int count) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) values.push_back(low + (high - low) * i / (count - 1));
  return values;
}

/// coarsest, twice that, and so on, up to finest; 0 < coarsest.
inline std::vector<int> doubling_range(int coarsest, int finest) {
  std::vector<int> values;
  for (int value = coarsest; value <= finest; value *= 2) values.push_back(value);
  return values;
}

/// coarsest, half of that, and so on: `count` values.
inline std::vector<double> halving_range(double coarsest, int count) {
  std::vector<double> values;
  for (int level = 0; level < count; ++level) values.push_back(std::ldexp(coarsest, -level));
  return values;
}

}  // namespace foldproof
