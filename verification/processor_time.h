// Processor time of the calling thread.
#pragma once

#include <ctime>

namespace foldproof {

/// Processor time of this thread [s]: other programs and threads affect it less than wall-clock
/// time.
inline double processor_seconds() {
  timespec spent{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &spent);
  return double(spent.tv_sec) + 1e-9 * double(spent.tv_nsec);
}

}  // namespace foldproof
