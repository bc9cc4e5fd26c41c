// The processor time of processes that someone else started.
#pragma once

#include <sys/types.h>

namespace foldproof {

/// Since their start [s]; NaN where the system does not say.
struct ProcessorTime {
  double computing;  // all their threads together
  double waiting;    // for a processor, others being at it: of their first threads
};

/// Of the living processes of a group.
ProcessorTime processor_time_of_group(pid_t group);

}  // namespace foldproof
