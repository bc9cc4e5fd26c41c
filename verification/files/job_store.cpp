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

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr long layout = 1;                 // of the index
constexpr size_t rows_at_a_time = 50'000;  // sorted by key, which is what makes inserting fast

std::string line_text(const json& value) {
  return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

json content_of(const JobResult& result) {
  return {{"end", name_of(result.end)},
          {"reason", result.reason},
          {"values", result.values},
          {"digest", result.digest}};
}

json json_of(const std::string& key, const JobResult& result) {
  return {{"result", key},         {"content", content_of(result)}, {"seconds", result.seconds},
          {"clock", result.clock}, {"bytes", result.bytes},         {"kept", result.kept},
          {"host", result.host},   {"date", result.date},           {"commit", result.commit}};
}

/// Thrown for a line that claims to be a result, and is none.
struct NoResult : std::runtime_error {
  using std::runtime_error::runtime_error;
};

JobEnd end_named(const std::string& name) {
  for (const JobEnd end : job_ends())
    if (name == name_of(end)) return end;
  throw NoResult("'" + name + "' is no end of a job");
}

JobResult result_of(const json& content) {
  JobResult result;
  result.end = end_named(content.at("end").get<std::string>());
  result.reason = content.at("reason").get<std::string>();
  result.digest = content.at("digest").get<std::string>();
  for (const auto& [name, value] : content.at("values").items())
    result.values[name] = value.is_null() ? not_a_number : value.get<double>();
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

}  // namespace

const std::vector<JobEnd>& job_ends() {
  static const std::vector<JobEnd> all = {JobEnd::holds,     JobEnd::fails,
                                          JobEnd::stopped,   JobEnd::refused,
                                          JobEnd::timed_out, JobEnd::out_of_memory};
  return all;
}

std::string name_of(JobEnd end) {
  switch (end) {
    case JobEnd::holds:
      return "holds";
    case JobEnd::fails:
      return "fails";
    case JobEnd::stopped:
      return "stopped";
    case JobEnd::refused:
      return "refused";
    case JobEnd::timed_out:
      return "timed out";
    case JobEnd::out_of_memory:
      return "out of memory";
  }
  return "";
}

void JobShard::start(const std::string& key, const std::string& label) {
  file_.append(line_text({{"start", key}, {"label", label}}));
}

void JobShard::end(const std::string& key, const JobResult& result, const Units& units) {
  json fresh = json::object();
  for (const auto& [name, unit] : units)
    if (units_.insert(name).second) fresh[name] = unit;
  if (!fresh.empty()) file_.append(line_text({{"units", fresh}}));
  file_.append(line_text(json_of(key, result)));
}

void JobShard::interrupt(const std::string& key) {
  file_.append(line_text({{"interrupted", key}}));
}

std::string JobShard::line_of(const std::string& key, const JobResult& result) {
  return line_text(json_of(key, result)) + "\n";
}

ShardState read_shard_state(const std::vector<std::string>& paths) {
  ShardState state;
  for (const std::string& path : paths)
    read_whole_lines(path, 0, [&](const std::string& line) {
      const json record = json::parse(line, nullptr, false);
      if (!record.is_object()) return;
      for (const auto& [what, change] :
           {std::pair("start", 1), {"interrupted", -1}, {"result", -1}})
        if (record.contains(what) && record[what].is_string())
          state.open_starts[record[what]] += change;
      if (record.contains("result") && record["result"].is_string())
        state.results.insert(record["result"]);
    });
  std::erase_if(state.open_starts, [](const auto& entry) { return entry.second <= 0; });
  return state;
}

namespace {

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

struct JobIndex::Row {
  std::string key, content;
  JobResult result;
};

JobIndex::JobIndex(const std::string& store) : store_(store) {
  if (fs::exists(store) && !fs::is_directory(store))
    throw InputError(store + ": results are kept in a folder, and this is none");
  fs::create_directories(store);
  try {
    open();
  } catch (const std::runtime_error&) {  // whatever it is, the shards have all that it had
    database_.reset();
    for (const char* end : {"", "-journal"}) fs::remove(store_ + "/index.sqlite" + end);
    open();
  }
}

void JobIndex::open() {
  database_.emplace(store_ + "/index.sqlite");
  database_->run(R"(
    create table if not exists layout(version integer);
    create table if not exists results(key text primary key, content text, end text, seconds real,
      bytes integer, kept text, host text, date text, program text) without rowid;
    create table if not exists open_starts(shard text, key text, primary key(shard, key))
      without rowid;
    create table if not exists conflicts(key text, shard text, content text,
      primary key(key, shard));
    create table if not exists repeated(key text, shard text, primary key(key, shard))
      without rowid;
    create table if not exists units(name text primary key, unit text);
    create table if not exists shards(name text primary key, bytes integer);
    insert into layout select 1 where not exists (select * from layout);)");
  SqliteQuery version = database_->query("select version from layout");
  if (!version.next() || version.whole(0) != layout)
    throw std::runtime_error(store_ + "/index.sqlite: of another layout");
  find_ = database_->query(
      "select content, seconds, bytes, kept, host, date, program from results where key = ?");
  contains_ = database_->query("select 1 from results where key = ?");
}

void JobIndex::add_line(const std::string& line, const std::string& shard, std::vector<Row>& rows) {
  const json record = json::parse(line, nullptr, false);
  try {
    if (record.contains("start")) {
      database_->query("insert or ignore into open_starts values(?, ?)")
          .bind(shard)
          .bind(record.at("start").get<std::string>())
          .run();
    } else if (record.contains("units")) {
      for (const auto& [name, unit] : record.at("units").items())
        database_->query("insert or ignore into units values(?, ?)")
            .bind(name)
            .bind(unit.get<std::string>())
            .run();
    } else {
      const bool is_result = record.contains("result");
      const auto key = record.at(is_result ? "result" : "interrupted").get<std::string>();
      if (is_result) rows.push_back({key, line_text(record.at("content")), result_of_line(record)});
      database_->query("delete from open_starts where shard = ? and key = ?")
          .bind(shard)
          .bind(key)
          .run();
    }
  } catch (const json::exception&) {  // torn by a full disk, or none of ours
  } catch (const NoResult&) {         // of another version
  }
}

long JobIndex::insert(std::vector<Row>& rows, const std::string& shard) {
  std::ranges::stable_sort(rows, {}, &Row::key);
  SqliteQuery add = database_->query(
      "insert into results values(?, ?, ?, ?, ?, ?, ?, ?, ?) on conflict(key) do nothing");
  long added = 0;
  for (const Row& row : rows) {
    const JobResult& result = row.result;
    add.bind(row.key).bind(row.content).bind(name_of(result.end));
    add.bind(result.seconds).bind(result.bytes);
    add.bind(result.kept).bind(result.host).bind(result.date).bind(result.commit).run();
    if (database_->changes() > 0) {
      ++added;
      continue;
    }
    database_->query("insert or ignore into repeated values(?, ?)").bind(row.key).bind(shard).run();
    SqliteQuery first = database_->query("select content from results where key = ?");
    if (first.bind(row.key).next() && first.text(0) != row.content)
      database_->query("insert or ignore into conflicts values(?, ?, ?)")
          .bind(row.key)
          .bind(shard)
          .bind(row.content)
          .run();
  }
  rows.clear();
  return added;
}

long JobIndex::merge_shard(const std::string& path, const std::string& name) {
  SqliteQuery known = database_->query("select bytes from shards where name = ?");
  const long read = known.bind(name).next() ? known.whole(0) : 0;
  std::error_code unreadable;  // its size is then -1
  if (long(fs::file_size(path, unreadable)) <= read) return 0;
  std::vector<Row> rows;
  long added = 0;
  const auto end = read_whole_lines(path, std::uint64_t(read), [&](const std::string& line) {
    add_line(line, name, rows);
    if (rows.size() >= rows_at_a_time) added += insert(rows, name);
  });
  added += insert(rows, name);
  database_->query("insert or replace into shards values(?, ?)").bind(name).bind(long(end)).run();
  return added;
}

long JobIndex::merge() {
  const auto shards = shards_in(store_ + "/batches");
  long added = 0;
  database_->run("begin immediate");
  try {
    for (const auto& [path, name] : shards) added += merge_shard(path, name);
    database_->run("commit");
  } catch (...) {
    database_->roll_back();
    throw;
  }
  return added;
}

JobIndex::Reading::Reading(JobIndex& index) : index_(index) { index_.database_->run("begin"); }
JobIndex::Reading::~Reading() {
  try {
    index_.database_->run("commit");
  } catch (const std::exception&) {  // nothing was changed, so nothing is lost
  }
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

bool JobIndex::contains(const std::string& key) {
  const bool is_there = contains_->bind(key).next();
  if (is_there) contains_->reset();
  return is_there;
}

std::map<std::string, int> JobIndex::open_starts() {
  std::map<std::string, int> counts;
  SqliteQuery query = database_->query("select key, count(*) from open_starts group by key");
  while (query.next()) counts[query.text(0)] = int(query.whole(1));
  return counts;
}

std::set<std::string> JobIndex::open_starts_in(const std::string& batch) {
  std::set<std::string> keys;
  SqliteQuery query =
      database_->query("select key from open_starts where substr(shard, 1, length(?)) = ?");
  query.bind(batch + "/").bind(batch + "/");
  while (query.next()) keys.insert(query.text(0));
  return keys;
}

std::vector<JobIndex::Conflict> JobIndex::conflicts() {
  std::vector<Conflict> all;
  SqliteQuery query = database_->query("select key, shard, content from conflicts");
  while (query.next()) all.push_back({query.text(0), query.text(1), query.text(2)});
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
