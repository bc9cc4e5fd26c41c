#include "verification/files/job_store.h"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "reference/types.h"

namespace foldproof {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr long layout = 2;  // of the index
constexpr const char* end_names[] = {"holds",   "fails",     "stopped",
                                     "refused", "timed out", "out of memory"};  // as JobEnd

std::string line_text(const json& value) {
  return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

/// Thrown for a line that claims to be a result, and is none.
struct NoResult : std::runtime_error {
  using std::runtime_error::runtime_error;
};

JobEnd end_named(const std::string& name) {
  const auto found = std::ranges::find(end_names, name);
  if (found == std::end(end_names)) throw NoResult("'" + name + "' is no end of a job");
  return JobEnd(found - end_names);
}

JobResult result_of(const json& content) {
  JobResult result;
  result.end = end_named(content.at("end"));
  result.reason = content.at("reason");
  result.digest = content.at("digest");
  for (const auto& [name, value] : content.at("values").items())
    result.values[name] =
        value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
  return result;
}

/// All that the index keeps of a result's line.
JobResult result_of_line(const json& record) {
  JobResult result = result_of(record.at("content"));
  result.seconds = record.value("seconds", 0.0);
  result.bytes = record.value("bytes", 0L);
  result.kept = record.value("kept", "");
  result.host = record.value("host", "");
  result.date = record.value("date", "");
  result.commit = record.value("commit", "");
  return result;
}

/// Shards of all batches, sorted: path; name, as BATCH/SHARD.
std::vector<std::pair<std::string, std::string>> shards_in(const std::string& batches) {
  std::vector<std::pair<std::string, std::string>> shards;
  std::error_code is_missing;
  for (const auto& batch : fs::directory_iterator(batches, is_missing))
    for (const auto& shard : fs::recursive_directory_iterator(batch.path() / "shards", is_missing))
      if (shard.path().extension() == ".jsonl")
        shards.emplace_back(shard.path(),
                            batch.path().filename().string() + "/" + shard.path().stem().string());
  std::ranges::sort(shards);
  return shards;
}

}  // namespace

std::string name_of(JobEnd end) { return end_names[size_t(end)]; }

std::string start_line(const std::string& key, const std::string& label) {
  return line_text({{"start", key}, {"label", label}});
}

std::string result_line(const std::string& key, const JobResult& result) {
  const json content = {{"end", name_of(result.end)},
                        {"reason", result.reason},
                        {"values", result.values},
                        {"digest", result.digest}};
  return line_text({{"result", key},
                    {"content", content},
                    {"seconds", result.seconds},
                    {"clock", result.clock},
                    {"bytes", result.bytes},
                    {"kept", result.kept},
                    {"host", result.host},
                    {"date", result.date},
                    {"commit", result.commit}});
}

std::string interruption_line(const std::string& key) { return line_text({{"interrupted", key}}); }
std::string units_line(const Units& units) { return line_text({{"units", units}}); }

JobIndex::JobIndex(const std::string& store) : store_(store) {
  if (fs::exists(store) && !fs::is_directory(store))
    throw InputError(store + ": results are kept in a folder, and this is none");
  fs::create_directories(store);
  try {
    open(store + "/index.sqlite");
  } catch (const std::runtime_error&) {  // whatever it is, the shards have all that it had
    database_.reset();
    for (const char* end : {"", "-journal"}) fs::remove(store_ + "/index.sqlite" + end);
    open(store + "/index.sqlite");
  }
}

JobIndex::JobIndex(const std::vector<std::string>& shards) {
  open(":memory:");
  for (const std::string& path : shards) merge_shard(path, path);
}

void JobIndex::open(const std::string& path) {
  database_.emplace(path);
  database_->run(R"(
    create table if not exists layout(version integer);
    create table if not exists results(key text primary key, content text, end text, seconds real,
      bytes integer, kept text, host text, date text, program text);
    create table if not exists conflicts(key text, shard text, content text,
      primary key(key, shard));
    create table if not exists repeated(key text, shard text, primary key(key, shard))
      without rowid;
    create table if not exists open_starts(key text primary key, count integer) without rowid;
    create table if not exists units(name text primary key, unit text);
    create table if not exists shards(name text primary key, bytes integer);)");
  database_->run("insert into layout select " + std::to_string(layout) +
                 " where not exists (select * from layout)");
  SqliteQuery version = database_->query("select version from layout");
  if (!version.next() || version.whole(0) != layout)
    throw std::runtime_error(path + ": of another layout");
  find_ = database_->query(
      "select content, seconds, bytes, kept, host, date, program from results where key = ?");
}

bool JobIndex::add_result(const std::string& key, const std::string& content,
                          const JobResult& result, const std::string& shard) {
  SqliteQuery add = database_->query(
      "insert into results values(?, ?, ?, ?, ?, ?, ?, ?, ?) on conflict(key) do nothing");
  add.bind(key, content, name_of(result.end), result.seconds, result.bytes);
  add.bind(result.kept, result.host, result.date, result.commit).run();
  if (database_->changes() > 0) return true;
  database_->query("insert or ignore into repeated values(?, ?)").bind(key, shard).run();
  if (!result.kept.empty())  // repeated for the sake of its files
    database_->query("update results set kept = ?, bytes = ? where key = ? and kept = ''")
        .bind(result.kept, result.bytes, key)
        .run();
  SqliteQuery first = database_->query("select content from results where key = ?");
  if (first.bind(key).next() && first.text(0) != content)
    database_->query("insert or ignore into conflicts values(?, ?, ?)")
        .bind(key, shard, content)
        .run();
  return false;
}

bool JobIndex::add_line(const std::string& line, const std::string& shard) {
  const json record = json::parse(line, nullptr, false);
  try {
    if (record.contains("units")) {
      for (const auto& [name, unit] : record.at("units").items())
        database_->query("insert or ignore into units values(?, ?)")
            .bind(name, unit.get<std::string>())
            .run();
      return false;
    }
    const bool is_start = record.contains("start"), is_result = record.contains("result");
    const std::string key = record.at(is_start ? "start" : is_result ? "result" : "interrupted");
    const bool is_new = is_result && add_result(key, line_text(record.at("content")),
                                                result_of_line(record), shard);
    database_
        ->query(
            "insert into open_starts values(?, ?) "
            "on conflict(key) do update set count = count + excluded.count")
        .bind(key, is_start ? 1L : -1L)
        .run();
    return is_new;
  } catch (const json::exception&) {  // torn by a full disk, or none of ours
  } catch (const NoResult&) {         // of another version
  }
  return false;
}

long JobIndex::merge_shard(const std::string& path, const std::string& name) {
  SqliteQuery known = database_->query("select bytes from shards where name = ?");
  const long read = known.bind(name).next() ? known.whole(0) : 0;
  std::error_code unreadable;  // its size is then -1
  if (long(fs::file_size(path, unreadable)) <= read) return 0;
  long added = 0;
  const auto end = read_whole_lines(
      path, std::uint64_t(read), [&](const std::string& line) { added += add_line(line, name); });
  database_->query("insert or replace into shards values(?, ?)").bind(name, long(end)).run();
  return added;
}

long JobIndex::merge() {
  const auto shards = shards_in(store_ + "/batches");
  SqliteTransaction transaction(*database_, "begin immediate");
  long added = 0;
  for (const auto& [path, name] : shards) added += merge_shard(path, name);
  database_->run("delete from open_starts where count = 0");
  transaction.commit();
  return added;
}

std::optional<JobResult> JobIndex::find(const std::string& key) {
  if (!find_->bind(key).next()) return {};
  JobResult result = result_of(json::parse(find_->text(0)));
  result.seconds = find_->number(1);
  result.bytes = find_->whole(2);
  result.kept = find_->text(3);
  result.host = find_->text(4);
  result.date = find_->text(5);
  result.commit = find_->text(6);
  find_->reset();
  return result;
}

std::map<std::string, int> JobIndex::open_starts() {
  std::map<std::string, int> counts;
  SqliteQuery query = database_->query("select key, count from open_starts where count > 0");
  while (query.next()) counts[query.text(0)] = int(query.whole(1));
  return counts;
}

std::vector<JobIndex::Conflict> JobIndex::conflicts() {
  std::vector<Conflict> all;
  SqliteQuery query = database_->query("select key, shard from conflicts");
  while (query.next()) all.push_back({query.text(0), query.text(1)});
  return all;
}

long JobIndex::repeated() {
  SqliteQuery query = database_->query("select count(*) from repeated");
  return query.next() ? query.whole(0) : 0;
}

Units JobIndex::units() {
  Units all;
  SqliteQuery query = database_->query("select name, unit from units");
  while (query.next()) all[query.text(0)] = query.text(1);
  return all;
}

}  // namespace foldproof
