// Working through a slice of a batch: several processes of the program, each with a shard.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "scripts/program/campaign/batch.h"

namespace foldproof {

constexpr int most_starts = 3;  // without an end, after which a job counts as crashed

struct WorkSettings {
  int processes = 1;   // jobs at a time
  std::string cache;   // folder of level sets; "": none
  std::string shards;  // folder for shards; "": the slice's own
};

/// What came of a slice, by its processes.
struct WorkDone {
  size_t ended = 0;                 // jobs with a result
  size_t crashed = 0;               // jobs with most_starts starts and no end
  std::vector<std::string> shards;  // that its processes wrote
};

/// Runs the jobs, those with the fewest starts first. A job whose process dies costs nothing but
/// itself: another process goes on, and starts it again after all others, until it has most_starts.
/// Calls `show` a few times a second with the number of jobs that ended. Passes on what `show`
/// throws, after its processes have noted what they interrupt. Throws std::runtime_error if results
/// cannot be written.
WorkDone work_through(const Batch& batch, size_t slice, std::vector<BatchJob> jobs,
                      const WorkSettings& settings, const std::function<void(size_t)>& show);

/// Those of the jobs that the shards have no result of, with the starts that they show.
std::vector<BatchJob> missing_in(const std::vector<std::string>& shards,
                                 std::vector<BatchJob> jobs);

}  // namespace foldproof
