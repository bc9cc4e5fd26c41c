// The index of a campaign's store: which shards it reads, and what it makes of repetitions.
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sqlite3.h>

#include "reference/types.h"
#include "verification/files/job_store.h"
#include "verification/specimens/scratch_folder.h"

namespace foldproof {

namespace {

namespace fs = std::filesystem;

std::string line_of(const std::string& key, double height) {
  JobResult result;
  result.values = {{"height", height}};
  return JobShard::line_of(key, result);
}

struct Store {
  ScratchFolder scratch;
  std::string folder = scratch.file("store");

  /// file: below the folder of batches.
  std::string add(const std::string& file, const std::string& text) const {
    const std::string path = folder + "/batches/" + file;
    fs::create_directories(fs::path(path).parent_path());
    std::ofstream(path, std::ios::app) << text;
    return path;
  }

  SqliteFile index() const { return SqliteFile(folder + "/index.sqlite"); }
};

/// The first number that a query of the index gives.
long number_in(const Store& store, const std::string& sql) {
  SqliteFile index = store.index();
  SqliteQuery query = index.query(sql);
  REQUIRE(query.next());
  return query.whole(0);
}

/// Whether another program can write to the index now.
bool is_writable(const Store& store) {
  sqlite3* other = nullptr;
  sqlite3_open((store.folder + "/index.sqlite").c_str(), &other);
  const int result =
      sqlite3_exec(other, "update layout set version = version", nullptr, nullptr, nullptr);
  sqlite3_close_v2(other);
  return result == SQLITE_OK;
}

}  // namespace

TEST_CASE("job index: shards are the .jsonl files at any depth below a batch's folder of shards") {
  const Store store;
  store.add("one/shards/a.jsonl", line_of("k1", 0.5));
  store.add("one/shards/0003/deep/b.jsonl", line_of("k2", 0.5));
  store.add("two/shards/a.jsonl", line_of("k3", 0.5));
  store.add("one/shards/c.json", line_of("other ending", 0.5));
  store.add("one/d.jsonl", line_of("beside", 0.5));
  store.add("three/list.txt", "a batch without shards");
  store.add("a file", "no batch");
  JobIndex index(store.folder);
  CHECK(index.merge() == 3);
  for (const char* key : {"k1", "k2", "k3"}) CHECK(index.contains(key));
  CHECK(number_in(store, "select count(*) from shards") == 3);
  for (const char* name : {"one/a", "one/b", "two/a"})
    CHECK(number_in(store,
                    "select count(*) from shards where name = '" + std::string(name) + "'") == 1);
}

TEST_CASE("job index: a store without batches is made, and empty") {
  const Store store;
  JobIndex index(store.folder);
  CHECK(fs::is_directory(store.folder));
  CHECK(index.merge() == 0);
  CHECK(index.repeated() == 0);
  CHECK(index.conflicts().empty());
  CHECK(index.units().empty());
  CHECK(index.open_starts().empty());
}

TEST_CASE("job index: of results that differ the one of the first shard counts") {
  const Store store;
  for (const int k : {4, 2, 6, 1, 5, 3})
    store.add("b/shards/s" + std::to_string(k) + ".jsonl", line_of("k", 0.25 * k));
  store.add("b/shards/s5.jsonl", line_of("k", 9.5));
  store.add("b/shards/s6.jsonl", line_of("j", 0.5) + line_of("k", 0.25));
  JobIndex index(store.folder);
  CHECK(index.merge() == 2);
  CHECK(index.find("k").value().values.at("height") == 0.25);
  CHECK(index.find("j").value().values.at("height") == 0.5);
  CHECK(index.repeated() == 5);
  const std::vector<JobIndex::Conflict> conflicts = index.conflicts();
  REQUIRE(conflicts.size() == 5);
  for (const JobIndex::Conflict& one : conflicts) {
    CHECK(one.key == "k");
    REQUIRE(one.shard.size() == 4);
    const int k = one.shard.back() - '0';
    CHECK(one.shard == "b/s" + std::to_string(k));
    CHECK(nlohmann::json::parse(one.content) ==
          nlohmann::json::parse(R"({"end":"holds","reason":"","digest":"","values":{"height":)" +
                                std::to_string(0.25 * k) + "}}"));
  }
}

TEST_CASE("job index: repetitions that agree are counted once a shard") {
  const Store store;
  const std::string line = line_of("k", 0.75);
  store.add("b/shards/a.jsonl", line + line + line);
  store.add("b/shards/b.jsonl", line + line_of("j", 3.5));
  JobIndex index(store.folder);
  CHECK(index.merge() == 2);
  CHECK(index.repeated() == 2);
  CHECK(index.conflicts().empty());
}

TEST_CASE("job index: of a shard only what it has gained is read") {
  const Store store;
  const std::string line = line_of("k", 0.75), other = line_of("j", 3.5);
  store.add("b/shards/a.jsonl", line + other.substr(0, 7));
  JobIndex index(store.folder);
  CHECK(index.merge() == 1);
  CHECK(number_in(store, "select bytes from shards") == long(line.size()));
  store.add("b/shards/a.jsonl", other.substr(7));
  CHECK(index.merge() == 1);
  CHECK(number_in(store, "select bytes from shards") == long(line.size() + other.size()));
  CHECK(index.merge() == 0);
  CHECK(index.repeated() == 0);
  CHECK(index.contains("j"));
}

TEST_CASE("job index: starts are of their shard, and a batch's name is not the beginning of one") {
  const Store store;
  const std::string start = "{\"start\":\"k\",\"label\":\"\"}\n", end = line_of("k", 0.5);
  store.add("one/shards/a.jsonl", start + start);
  store.add("one/shards/b.jsonl", start + end);
  store.add("one/shards/c.jsonl",
            "{\"start\":\"j\"}\n{\"start\":\"i\"}\n{\"interrupted\":\"j\"}\n");
  store.add("one more/shards/a.jsonl", "{\"start\":\"k\"}\n{\"start\":\"h\"}\n");
  JobIndex index(store.folder);
  CHECK(index.merge() == 1);
  CHECK(index.open_starts() == std::map<std::string, int>{{"k", 2}, {"i", 1}, {"h", 1}});
  CHECK(index.open_starts_in("one") == std::set<std::string>{"k", "i"});
  CHECK(index.open_starts_in("one more") == std::set<std::string>{"k", "h"});
  CHECK(index.open_starts_in("two").empty());
  CHECK(index.open_starts_in("").empty());
}

TEST_CASE("job index: a store that is a file is refused by its name") {
  const ScratchFolder scratch;
  const std::string path = scratch.write("store", "a file");
  CHECK_THROWS_WITH(JobIndex(path), path + ": results are kept in a folder, and this is none");
  CHECK_THROWS_AS(JobIndex(path), InputError);
}

TEST_CASE("job index: one that cannot be made says where") {
  const ScratchFolder scratch;
  const std::string folder = scratch.file("store");
  fs::create_directories(folder + "/index.sqlite/in the way");
  CHECK_THROWS_WITH(JobIndex(folder), Catch::Contains(folder + "/index.sqlite"));
}

TEST_CASE("job index: while it is read, others wait; then they need not") {
  const Store store;
  store.add("b/shards/a.jsonl", line_of("k", 0.5));
  JobIndex index(store.folder);
  CHECK(index.merge() == 1);
  CHECK(is_writable(store));
  {
    const JobIndex::Reading reading(index);
    CHECK(index.contains("k"));
    CHECK(index.find("k").has_value());
    CHECK_FALSE(is_writable(store));
    CHECK(index.contains("k"));
  }
  CHECK(is_writable(store));
  CHECK(index.contains("k"));
  CHECK(index.find("k").has_value());
  CHECK(is_writable(store));  // a look-up leaves no lock
  CHECK(index.merge() == 0);
}

TEST_CASE("job index: a merge that another writer's line stops leaves the index as it was") {
  const Store store;
  store.add("b/shards/a.jsonl", line_of("k", 0.5));
  JobIndex index(store.folder);
  CHECK(index.merge() == 1);
  store.index().run("drop table repeated");
  store.add("b/shards/b.jsonl", line_of("j", 0.5) + line_of("k", 0.5));
  CHECK_THROWS_WITH(index.merge(), Catch::Contains("index.sqlite") && Catch::Contains("repeated"));
  CHECK_FALSE(index.contains("j"));
  CHECK(is_writable(store));
  store.index().run("create table repeated(key text, shard text)");
  CHECK(index.merge() == 1);
  CHECK(index.contains("j"));
  CHECK(index.repeated() == 1);
}

TEST_CASE("job index: more results than are inserted at a time are each found once") {
  const Store store;
  constexpr int results = 50'003;
  std::string text;
  for (int k = 0; k < results; ++k)
    text += "{\"result\":\"" + std::to_string(k) +
            R"(","content":{"end":"holds","reason":"","digest":"","values":{}}})" + "\n";
  store.add("b/shards/a.jsonl", text);
  store.add("b/shards/b.jsonl", line_of("last", 0.5));
  JobIndex index(store.folder);
  CHECK(index.merge() == results + 1);
  CHECK(index.repeated() == 0);
  CHECK(index.contains("0"));
  CHECK(index.contains("50002"));
}

}  // namespace foldproof
