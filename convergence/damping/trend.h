// Does a quantity that fluctuates drift? Its slope in time, and how far chance alone may tilt it.
#pragma once

#include <vector>

namespace foldproof {

struct Trend {
  double slope = 0;           // of the quantity, by least squares over the blocks [unit/unit of time]
  double error = 0;           // its standard error
  std::vector<double> times;  // middles of the blocks
  std::vector<double> means;  // of the quantity over each block
};

/// Averages the samples over `blocks` equal spans of time, so that what is correlated within a block counts
/// once, and fits a line. The standard error comes from the scatter about the line, enlarged by sqrt((1 +
/// r)/(1 - r)) where neighbouring blocks are still correlated, r > 0 being the lag-one correlation of the
/// scatter. Times must ascend, one for each value, and there must be a sample in every block, else
/// InputError.
Trend trend_of(const std::vector<double>& times, const std::vector<double>& values, int blocks);

/// At most some 500 of the values, evenly chosen.
std::vector<double> thinned(const std::vector<double>& values);

}  // namespace foldproof
