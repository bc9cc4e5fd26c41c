// A batch: jobs that were given out together, as a folder of the store.
#pragma once

#include <fstream>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "convergence/campaigns/campaign.h"

namespace foldproof {

/// A job that is to be run.
struct BatchJob {
  std::string key, label;
  std::vector<Assignment> set;
  int starts = 0;  // without an end, before this batch
};

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
///   batch.json            the terms, the engine, and who wrote it
///   slices/000000.jsonl   a job a line; locked by the process that works on it
///   shards/0000/*.jsonl   results (verification/files/job_store.h), a folder for 100 slices
///   ended                 it has finished, or was given up
struct Batch {
  std::string folder, name;
  BatchTerms terms;
  std::string engine;  // "local", "slurm", or "emitted": commands that may run at any time
  std::string writer;  // "HOST PROCESS", which also runs it if the engine is local
  size_t jobs = 0, slices = 0;
};

/// A lock on a file, which is made if there is none. It ends with the process and those that it
/// forked. A file system without locks lets all in; what they do twice is found to be the same.
class FileLock {
 public:
  /// Waits for it; calls `wait` ten times a second, which may throw.
  explicit FileLock(
      const std::string& path, const std::function<void()>& wait = [] {});
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

  static bool is_held(const std::string& path);

 private:
  int file_;
};

/// Writes a new batch, a job at a time, as a million need not be in memory together. Holds the lock
/// of its first slice, so that the batch counts as worked on from the start. Throws
/// std::runtime_error naming a file that cannot be written.
class BatchWriter {
 public:
  BatchWriter(const BatchTerms& terms, const std::string& engine, size_t jobs_a_slice);

  void add(const BatchJob& job);
  size_t jobs() const { return batch_.jobs; }

  /// The batch with all its jobs; before, no one can see it. None without a job.
  std::optional<Batch> finish();

 private:
  void end_slice();

  Batch batch_;
  size_t jobs_a_slice_;
  std::optional<FileLock> lock_;
  std::ofstream file_;  // of the slice that is being written
};

/// Throws InputError for a folder that is no batch.
Batch read_batch(const std::string& folder);

std::vector<BatchJob> read_slice(const Batch& batch, size_t slice);

/// The shard files that a slice has so far.
std::vector<std::string> shards_of_slice(const Batch& batch, size_t slice);

/// A new one; another file than any other process writes to.
std::string new_shard_of_slice(const Batch& batch, size_t slice);

void mark_ended(const Batch& batch);

/// Batches that are not marked as ended.
std::vector<Batch> open_batches(const std::string& store);

/// One program at a time plans on a store.
std::string lock_of_store(const std::string& store);

/// One process at a time works on a slice: schedulers that crash start a slice twice.
std::string lock_of_slice(const Batch& batch, size_t slice);

}  // namespace foldproof
