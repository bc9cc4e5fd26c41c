#pragma once

namespace foldproof::oracles {

/// What an oracle answers: a number and how far the truth may lie from it, both in the same unit. The
/// uncertainty is never negative; a verdict adds it to the bound instead of trusting the value.
struct Estimate {
  double value = 0;
  double uncertainty = 0;
};

}  // namespace foldproof::oracles
