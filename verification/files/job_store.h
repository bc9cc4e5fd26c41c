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

const std::vector<JobEnd>& job_ends();
std::string name_of(JobEnd end);

struct JobResult {
  // the content, which every repetition must find again to the bit
  JobEnd end = JobEnd::holds;
  std::string reason;                    // why it failed, stopped or was refused
  std::map<std::string, double> values;  // in the units of JobShard::end
  std::string digest;                    // of the last state, or ""

  // what may differ between repetitions
  double seconds = 0;  // of the processor
  double clock = 0;    // seconds of the clock; in shards only
  long bytes = 0;      // of files that were kept
  std::string kept;    // their folder, below the store; "": none
  std::string host, date, commit;
};

using Units = std::map<std::string, std::string>;  // of values, by name

/// One process's part of a batch. A shard has these lines:
///   {"start": key, "label": text}            before a job runs
///   {"result": key, "content": {...}, ...}   when it has ended
///   {"interrupted": key}                     when it was stopped on request: as if never started
///   {"units": {name: unit}}                  before the first value of that name
class JobShard {
 public:
  explicit JobShard(const std::string& path) : file_(path) {}

  void start(const std::string& key, const std::string& label);
  void end(const std::string& key, const JobResult& result, const Units& units);
  void interrupt(const std::string& key);
  void flush_to_disk() { file_.flush_to_disk(); }

  /// The line of a result, with its end, to be written by a signal handler.
  static std::string line_of(const std::string& key, const JobResult& result);
  int descriptor() const { return file_.descriptor(); }

 private:
  ShardFile file_;
  std::set<std::string> units_;  // names whose unit was written
};

/// What a slice's earlier shards say: an element that a scheduler starts again goes on from here.
struct ShardState {
  std::set<std::string> results;
  std::map<std::string, int> open_starts;  // started without an end, how often
};

ShardState read_shard_state(const std::vector<std::string>& paths);

/// The index of a store, STORE/index.sqlite:
///   results(key, content, end, seconds, bytes, kept, host, date, program)
///   open_starts(shard, key)       started, not ended
///   conflicts(key, shard, content)  a repetition that found something else
///   repeated(key, shard)          every repetition
///   units(name, unit)
/// It can be deleted at any time; the next merge() makes it anew from the shards.
class JobIndex {
 public:
  /// Throws InputError if the store is not a folder, std::runtime_error if it cannot be written.
  /// An index that is damaged, or of another layout, is deleted.
  explicit JobIndex(const std::string& store);

  /// Reads what shards have gained since the last time: STORE/batches/*/shards/**/*.jsonl. Returns
  /// the number of new results. Several programs may merge at a time.
  long merge();

  /// While it lives, look-ups see one state of the index and take no lock each, which makes a
  /// million of them twice as fast; merge() has to wait.
  class Reading {
   public:
    explicit Reading(JobIndex& index);
    ~Reading();
    Reading(const Reading&) = delete;
    Reading& operator=(const Reading&) = delete;

   private:
    JobIndex& index_;
  };

  std::optional<JobResult> find(const std::string& key);
  bool contains(const std::string& key);

  /// Starts without an end, in all batches.
  std::map<std::string, int> open_starts();

  /// Those of one batch.
  std::set<std::string> open_starts_in(const std::string& batch);

  struct Conflict {
    std::string key, shard, content;
  };
  std::vector<Conflict> conflicts();

  /// How many results were found more than once, conflicts included.
  long repeated();

  Units units();

 private:
  struct Row;
  void open();
  long merge_shard(const std::string& path, const std::string& name);
  void add_line(const std::string& line, const std::string& shard, std::vector<Row>& rows);
  long insert(std::vector<Row>& rows, const std::string& shard);

  std::string store_;
  std::optional<SqliteFile> database_;
  std::optional<SqliteQuery> find_, contains_;
};

}  // namespace foldproof
