// A store of run results, keyed by their input: no run is repeated.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "verification/files/shard_file.h"

namespace foldproof {

/// Result of a run: arrays of numbers, and texts.
struct StoredResult {
  std::map<std::string, std::vector<double>> arrays;
  std::map<std::string, std::string> texts;
};

/// A folder that several programs may write to at a time:
///   shards/*.jsonl     one append-only file per process; a line {"start": key, "label": ...}
///                      when a run begins, and {"result": key, "texts": ..., "arrays":
///                      {name: length}} when it has ended; a torn last line is ignored
///   arrays/kk/key-SHARD.h5   the arrays of a result, written before its line; SHARD names the
///                      writer, so that no two write to one file
/// kk: the first two characters of the key, which is a digest of all that the result depends on.
/// Other lines, and arrays of a length that differs from their line's, are ignored. A run that was
/// started but has no result was interrupted, and is repeated. Safe to call from several threads;
/// a process does not see results that others add later.
class ResultStore {
 public:
  /// Stores nothing, finds nothing.
  ResultStore() = default;

  /// Reads the folder; creates nothing before the first result. Throws InputError naming the path
  /// if it is not a folder.
  explicit ResultStore(std::string folder);

  /// The result of this key, if there is one that can be read.
  std::optional<StoredResult> find(const std::string& key) const;

  /// Whether a result of this key is listed; its arrays are not looked at.
  bool contains(const std::string& key) const;

  void start(const std::string& key, const std::string& label);

  /// Throws std::runtime_error naming the file that cannot be written.
  void keep(const std::string& key, const StoredResult& result);

  /// How often a run of this key was started.
  int starts(const std::string& key) const;

 private:
  struct Line {
    std::map<std::string, std::string> texts;
    std::map<std::string, size_t> lengths;  // of the arrays that are not empty
    std::string shard;
  };

  std::optional<StoredResult> read(const std::string& key, const Line& line) const;
  void read_shard(const std::string& path, const std::string& shard);
  void append(const std::string& line);
  std::string arrays_file(const std::string& key, const std::string& shard) const;

  std::string folder_, shard_;                        // shard_: the name without ".jsonl"
  std::unique_ptr<ShardFile> file_;                   // of this process; from its first line on
  std::map<std::string, std::vector<Line>> results_;  // by key, the latest last
  std::map<std::string, int> starts_;
  mutable std::mutex mutex_;
};

}  // namespace foldproof
