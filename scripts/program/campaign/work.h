// Working through jobs: several processes of the program, and one shard with all that they find.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "scripts/program/campaign/batch.h"

namespace foldproof {

constexpr int most_starts = 3;  // without an end, after which a job counts as crashed

struct WorkSettings {
  int processes = 1;  // jobs at a time
  std::string cache;  // folder of level sets; "": none
};

/// Runs the jobs, those with the fewest starts first, and writes what comes of them to the shard. A
/// job whose process dies costs nothing but itself: another process goes on, and starts it again
/// after all others, until it has most_starts. A job beyond its seconds ends as timed out. Calls
/// `show` several times a second with the number of jobs that have a result. Passes on what `show`
/// throws, after the jobs that it interrupts are noted. Throws std::runtime_error if results cannot
/// be written.
void work_through(const BatchTerms& terms, std::vector<BatchJob> jobs, const WorkSettings& settings,
                  const std::string& shard, const std::function<void(size_t)>& show);

/// Those of the jobs that the shards have no result of, with the starts that they show.
std::vector<BatchJob> missing_in(const std::vector<std::string>& shards,
                                 std::vector<BatchJob> jobs);

}  // namespace foldproof
