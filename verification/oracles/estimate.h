#pragma once

namespace foldproof::oracles {

/// Answer of an oracle: a number and its uncertainty, both in the same unit. The uncertainty is
/// never negative; a verdict adds it to the measured number's, against the same bound.
struct Estimate {
  double value = 0;
  double uncertainty = 0;
};

}  // namespace foldproof::oracles
