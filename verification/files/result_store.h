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
///   arrays/kk/key-SHARD.h5   the arrays of a result, there before its line is written; SHARD names
///                      the writer, so that no two write to one file
/// kk: the first two characters of the key. Lines that are none of these, and arrays that are
/// not as long as the line says, are as if they had never been written. The key is the
/// caller's: a digest of all that the result depends on. A run that was started and has no
/// result was cut off, and is made again. Safe to call from several threads; a process does not
/// see what others add later.
class ResultStore {
 public:
  /// Keeps nothing, finds nothing.
  ResultStore() = default;

  /// Reads what the folder has; makes nothing before the first result. Throws InputError naming the
  /// folder if it is something else than a folder.
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
  std::map<std::string, std::vector<Line>> results_;  // by key, the latest last
  std::map<std::string, int> starts_;
  mutable std::mutex mutex_;
};

}  // namespace foldproof
