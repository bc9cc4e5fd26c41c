// A batch: jobs that an engine was given together, as a folder of the store.
#pragma once

#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "convergence/campaigns/campaign.h"

namespace foldproof {

/// A job that an engine is to run.
struct BatchJob {
  std::string key, label;
  std::vector<Assignment> set;
  int starts = 0;  // without an end, before this batch
};

/// The engine of batches that were printed as commands, of which no one knows when they run.
constexpr const char* emitted = "emitted";

/// What all jobs of a batch share.
struct BatchTerms {
  std::string store;     // its folder, absolute
  std::string campaign;  // its name
  std::string run, quantities;
  Keep keep = Keep::none;
  JobLimits limits;
  std::string program;  // digest; another program refuses the batch
};

/// STORE/batches/NAME:
///   batch.json           the terms, the engine and its handle
///   slices/000000.jsonl  a job a line
///   shards/0000/*.jsonl  results (verification/files/job_store.h), a folder for 100 slices
///   alive                touched by who runs it here, every few seconds
///   ended                it has finished, or was given up
struct Batch {
  std::string folder, name;
  BatchTerms terms;
  std::string engine, handle;  // handle: what the engine calls it
  size_t jobs = 0, slices = 0;
};

/// Writes a new batch, a job at a time, as a million need not be in memory together. Throws
/// std::runtime_error naming a file that cannot be written.
class BatchWriter {
 public:
  BatchWriter(const BatchTerms& terms, const std::string& engine, size_t jobs_a_slice);

  void add(const BatchJob& job);
  size_t jobs() const { return batch_.jobs; }

  /// The batch with all its jobs; before, no one can see it. None without a job.
  std::optional<Batch> finish();

 private:
  void next_slice();
  void end_slice();

  Batch batch_;
  size_t jobs_a_slice_;
  std::string path_;  // of the slice that is being written
  std::ofstream file_;
};

/// Writes what has become known of it: its handle.
void write_terms(const Batch& batch);

/// Throws InputError for a folder that is no batch.
Batch read_batch(const std::string& folder);

std::vector<BatchJob> read_slice(const Batch& batch, size_t slice);

/// Where the shards of a slice lie.
std::string shard_folder(const Batch& batch, size_t slice);

/// The shard files that a slice has so far.
std::vector<std::string> shards_of_slice(const Batch& batch, size_t slice);

/// The name of a new one.
std::string new_shard_of_slice(size_t slice);

void mark_alive(const Batch& batch);
void mark_ended(const Batch& batch);

/// Whether its runner touched it in the last minute.
bool is_marked_alive(const Batch& batch);

/// Batches that are not marked as ended.
std::vector<Batch> open_batches(const std::string& store);

/// One program at a time plans on a store; others wait. Lives as long as the lock.
class StoreLock {
 public:
  explicit StoreLock(const std::string& store);
  ~StoreLock();
  StoreLock(const StoreLock&) = delete;
  StoreLock& operator=(const StoreLock&) = delete;

 private:
  int file_;
};

}  // namespace foldproof
