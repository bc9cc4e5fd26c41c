// Seconds of a run that may be too short to be timed once.
#pragma once

#include <algorithm>
#include <utility>

#include "verification/processor_time.h"

namespace foldproof {

/// The result of run(), and the least processor time of up to four calls [s]; it is not called
/// again once 0.03 s are spent. All calls must do the same.
template <class Run>
auto timed_run(const Run& run) {
  constexpr int most_calls = 4;
  constexpr double enough_seconds = 0.03;
  const double start = processor_seconds();
  auto result = run();
  double spent = processor_seconds() - start, least = spent;
  for (int call = 1; call < most_calls && spent < enough_seconds; ++call) {
    const double before = processor_seconds();
    run();
    const double one = processor_seconds() - before;
    least = std::min(least, one);
    spent += one;
  }
  return std::pair(std::move(result), least);
}

}  // namespace foldproof
