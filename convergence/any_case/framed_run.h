// A run that a store keeps: its frames, its seconds, why it stopped. Questions about a case add
// what else they need of it.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "reference/types.h"
#include "verification/files/result_store.h"

namespace foldproof {

struct FramedRun {
  std::vector<double> times;    // of the frames [s]
  std::vector<PerParticle3> x;  // in each of them, 3 x N [m]
  double seconds = 0;           // of the processor, in the run's own thread
  std::string stopped;          // why the run came to no end, or ""
};

/// The run as the store has it: arrays "times", "positions", "seconds", text "stopped".
StoredResult packed_frames(const FramedRun& run);

/// Fills in what packed_frames kept of a run of N particles; false where something
/// of it is missing.
bool unpack_frames(const StoredResult& kept, Eigen::Index particles, FramedRun& run);

/// The array of this name; empty where there is none.
std::vector<double> array_of(const StoredResult& kept, const std::string& name);

/// How a kind of run is made, kept and read; `unpack` gives none for a result that it cannot use.
template <class Run>
struct RunKeeper {
  std::function<Run()> make;
  std::function<StoredResult(const Run&)> pack;
  std::function<std::optional<Run>(const StoredResult&)> unpack;
};

/// The run of this key from the store if it is there and of use; else made now and kept there.
template <class Run>
Run stored_or_made(ResultStore& store, const std::string& key, const std::string& label,
                   const RunKeeper<Run>& keeper) {
  if (const auto kept = store.find(key))
    if (std::optional<Run> run = keeper.unpack(*kept)) return *std::move(run);
  store.start(key, label);
  Run run = keeper.make();
  store.keep(key, keeper.pack(run));
  return run;
}

}  // namespace foldproof
