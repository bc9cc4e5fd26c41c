// How a fuzz target reports a finding.
#pragma once

#include <cstdio>
#include <cstdlib>

namespace foldproof {

/// Stops the process if the claim is not met, which makes libFuzzer keep the input.
inline void require(bool is_met, const char* claim) {
  if (is_met) return;
  std::fprintf(stderr, "not so: %s\n", claim);
  std::abort();
}

}  // namespace foldproof
