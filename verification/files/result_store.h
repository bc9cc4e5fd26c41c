// Results of runs, kept by what they are results of: a run that was made once is not made again.
#pragma once

#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace foldproof {

/// What a run leaves: arrays of numbers, and words.
struct StoredResult {
  std::map<std::string, std::vector<double>> arrays;
  std::map<std::string, std::string> texts;
};

/// A folder that several programs may write to at a time:
///   shards/*.jsonl     one file a process, which only grows; a line {"start": key, "label": ...}
///                      when a run begins, and {"result": key, "texts": ..., "arrays":
///                      {name: length}} when it has ended; a torn last line is ignored
///   arrays/kk/key.h5   the arrays of a result, there before its line is written
/// The key is the caller's: a digest of all that the result depends on. A run that was started and
/// has no result was cut off, and is made again. Safe to call from several threads.
class ResultStore {
 public:
  /// Keeps nothing, finds nothing.
  ResultStore() = default;

  /// Reads what the folder has; makes nothing before the first result. Throws InputError naming the
  /// folder if it is something else than a folder.
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
