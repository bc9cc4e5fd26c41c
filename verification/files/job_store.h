// The store of a campaign's jobs: shards of JSON lines are the truth, an SQLite index finds them.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "verification/files/shard_file.h"
#include "verification/files/sqlite_file.h"

namespace foldproof {

/// How a job ended. Failures are results: the same question gets the same answer, and is not asked
/// again. A job that was killed has no result.
enum class JobEnd { holds, fails, stopped, refused, timed_out, out_of_memory };

std::string name_of(JobEnd end);

using Units = std::map<std::string, std::string>;  // of values, by name

struct JobResult {
  // the content, which every repetition must find again to the bit
  JobEnd end = JobEnd::holds;
  std::string reason;                    // why it failed, stopped or was refused
  std::map<std::string, double> values;  // in the units that its shard names
  std::string digest;                    // of the last state, or ""

  // what may differ between repetitions
  double seconds = 0;  // of the processor
  double clock = 0;    // seconds of the clock; in shards only
  long bytes = 0;      // of files that were kept
  std::string kept;    // their folder, below the store; "": none
  std::string host, date, commit;
};

// Lines of a shard, without their end. A job that has a start more than ends is cut off.
std::string start_line(const std::string& key, const std::string& label);
std::string result_line(const std::string& key, const JobResult& result);
std::string interruption_line(const std::string& key);  // on request: as if never started
std::string units_line(const Units& units);             // before the first value of a name

/// The index of a store, STORE/index.sqlite:
///   results(key, content, end, seconds, bytes, kept, host, date, program)
///   conflicts(key, shard, content)  a repetition that found something else
///   repeated(key, shard)            every repetition
///   open_starts(key, count)         starts without an end
///   units(name, unit)
/// The first result of a key counts, and the first of its files. It can be deleted at any time; the
/// next merge() makes it anew from the shards.
class JobIndex {
 public:
  /// Throws InputError if the store is not a folder, std::runtime_error if it cannot be written.
  /// An index that is damaged, or of another layout, is deleted.
  explicit JobIndex(const std::string& store);

  /// Of these shards alone, in memory.
  explicit JobIndex(const std::vector<std::string>& shards);

  /// Reads what shards have gained since the last time: STORE/batches/*/shards/**/*.jsonl. Returns
  /// the number of new results. Several programs may merge at a time.
  long merge();

  /// While it lives, look-ups see one state of the index and take no lock each, which makes a
  /// million of them twice as fast; merge() has to wait.
  SqliteTransaction reading() { return {*database_, "begin"}; }

  std::optional<JobResult> find(const std::string& key);

  /// Starts without an end, in all batches.
  std::map<std::string, int> open_starts();

  struct Conflict {
    std::string key, shard;
  };
  std::vector<Conflict> conflicts();

  /// How many results were found more than once, conflicts included.
  long repeated();

  Units units();

 private:
  void open(const std::string& path);
  long merge_shard(const std::string& path, const std::string& name);

  // whether the result was not known
  bool add_line(const std::string& line, const std::string& shard);
  bool add_result(const std::string& key, const std::string& content, const JobResult& result,
                  const std::string& shard);

  std::string store_;
  std::optional<SqliteFile> database_;
  std::optional<SqliteQuery> find_;
};

}  // namespace foldproof
