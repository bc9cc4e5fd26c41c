// The clock of everything that measures seconds.
#pragma once

#include <ctime>

namespace foldproof {

/// What the processor has spent on this thread [s]: other programs and threads lengthen it less
/// than the clock on the wall.
inline double processor_seconds() {
  timespec spent{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &spent);
  return double(spent.tv_sec) + 1e-9 * double(spent.tv_nsec);
}

}  // namespace foldproof
