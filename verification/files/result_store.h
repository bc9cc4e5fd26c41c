// A store of run results, keyed by their input: no run is repeated.
#pragma once

#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

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
///   arrays/kk/key.h5   the arrays of a result, written before its line
/// The key is the caller's: a digest of all that the result depends on. A run that was started but
/// has no result was interrupted, and is repeated. Safe to call from several threads.
class ResultStore {
 public:
  /// Stores nothing, finds nothing.
  ResultStore() = default;

  /// Reads the folder; creates nothing before the first result. Throws InputError naming the path
  /// if it is not a folder.
  explicit ResultStore(std::string folder);

  /// The result of this key, if there is one that can be read.
  std::optional<StoredResult> find(const std::string& key) const;

  void start(const std::string& key, const std::string& label);

  /// Throws std::runtime_error naming the file that cannot be written.
  void keep(const std::string& key, const StoredResult& result);

  /// How often a run of this key was started.
  int starts(const std::string& key) const;

 private:
  void append(const std::string& line);
  std::string arrays_file(const std::string& key) const;

  std::string folder_, shard_;
  std::map<std::string, std::map<std::string, std::string>> texts_;  // of each result, by key
  std::map<std::string, int> starts_;
  mutable std::mutex mutex_;
};

}  // namespace foldproof
