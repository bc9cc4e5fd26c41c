// Engines: who places a batch's slices on machines, queues and retries them.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "scripts/program/campaign/batch.h"
#include "scripts/program/campaign/work.h"

namespace foldproof {

enum class BatchState { runs, has_ended, unknown };  // unknown: the engine does not answer now

/// What the user can say of an engine's machines.
struct EngineSettings {
  WorkSettings work;
  std::string options;   // passed to the engine's own command
  std::string scratch;   // folder on each node; "": shards are written where they belong
  size_t at_a_time = 0;  // slices; 0: as many as the engine likes
};

/// A row of the table of engines. Another one needs these functions and a row.
struct Engine {
  const char* name;
  const char* what;

  /// Whether it can be used here; "" or a reason.
  std::string (*missing)();

  /// Jobs of a batch: a batch waits for its slowest job, and is rarely much smaller than it may be.
  size_t most_jobs;

  /// Jobs a slice, of so many jobs of so many seconds each (NaN: not known).
  size_t (*jobs_a_slice)(size_t jobs, double seconds, const EngineSettings& settings);

  /// Submits the batch and returns at once, with batch.handle set; or runs it here and now. `show`
  /// gets the number of jobs that have ended, and may throw to interrupt it.
  void (*submit)(Batch& batch, const EngineSettings& settings,
                 const std::function<void(size_t)>& show);

  /// Where a submitted batch stands.
  BatchState (*ask)(const Batch& batch);

  /// Ends it; what has no result yet is missing.
  void (*cancel)(const Batch& batch);
};

const std::vector<Engine>& engines();

/// Throws InputError for a name that no engine has.
const Engine& engine_named(const std::string& name);

}  // namespace foldproof
