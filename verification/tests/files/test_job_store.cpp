// The store of a campaign's jobs: shards are the truth, the index only finds what they say.
#include <sys/resource.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <thread>

#include "reference/types.h"
#include "verification/files/job_store.h"
#include "verification/specimens/scratch_folder.h"
#include "verification/tests/files/small_files.h"

namespace foldproof {

namespace {

namespace fs = std::filesystem;

JobResult job_specimen() {
  JobResult result;
  result.end = JobEnd::fails;
  result.reason = "a \"word\", and\nanother";
  result.values = {{"height", 1.0 / 3}, {"lowest", std::nan("")}, {"tiny", 5e-324}};
  result.digest = "00ff";
  result.seconds = 2.5;
  result.host = "one";
  return result;
}

std::string shard_path(const ScratchFolder& scratch, const std::string& name) {
  return scratch.file("store/batches/batch/shards/0007/" + name + ".jsonl");
}

void append_text(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::app) << text;
}

}  // namespace

TEST_CASE("job store: a result is found as it was written, by this index and by a new one") {
  const ScratchFolder scratch;
  JobShard shard(shard_path(scratch, "a"));
  shard.start("k1", "label");
  shard.end("k1", job_specimen(), {{"height", "m"}});
  {
    JobIndex index(scratch.file("store"));
    CHECK(index.merge() == 1);
    CHECK(index.merge() == 0);
  }
  for (const bool is_rebuilt : {false, true}) {
    if (is_rebuilt) fs::remove(scratch.file("store/index.sqlite"));
    JobIndex index(scratch.file("store"));
    CHECK(index.merge() == (is_rebuilt ? 1 : 0));
    const auto found = index.find("k1");
    REQUIRE(found);
    CHECK(found->end == JobEnd::fails);
    CHECK(found->reason == job_specimen().reason);
    CHECK(found->values.at("height") == 1.0 / 3);
    CHECK(found->values.at("tiny") == 5e-324);
    CHECK(std::isnan(found->values.at("lowest")));
    CHECK(found->seconds == 2.5);
    CHECK(index.units().at("height") == "m");
    CHECK(index.contains("k1"));
    CHECK_FALSE(index.contains("k2"));
    CHECK(index.open_starts().empty());
    CHECK(index.repeated() == 0);
  }
}

TEST_CASE("job store: a torn tail is ignored, and read when it is whole") {
  const ScratchFolder scratch;
  JobShard(shard_path(scratch, "a")).end("k1", job_specimen(), {});
  const std::string line = JobShard::line_of("k2", job_specimen());
  append_text(shard_path(scratch, "a"), line.substr(0, line.size() / 2));
  JobIndex index(scratch.file("store"));
  CHECK(index.merge() == 1);
  CHECK_FALSE(index.contains("k2"));
  append_text(shard_path(scratch, "a"), line.substr(line.size() / 2));
  CHECK(index.merge() == 1);
  CHECK(index.contains("k2"));
  CHECK(index.repeated() == 0);
}

TEST_CASE("job store: damaged lines between whole ones are no results") {
  const ScratchFolder scratch;
  const std::string path = shard_path(scratch, "a");
  JobShard(path).end("k1", job_specimen(), {});
  append_text(path, "{\"result\": \"k2\", \"content\": {\"end\": \"ho\n");
  append_text(path, "{\"result\": \"k3\", \"content\": {\"end\": \"holds\"}}\n[1]\n7\n\n");
  append_text(path, JobShard::line_of("k4", job_specimen()));
  JobIndex index(scratch.file("store"));
  CHECK(index.merge() == 2);
  for (const char* key : {"k2", "k3"}) CHECK_FALSE(index.contains(key));
  CHECK(index.contains("k4"));
}

TEST_CASE("job store: a repetition that finds the same is counted, another one is a conflict") {
  const ScratchFolder scratch;
  JobResult first = job_specimen(), same = job_specimen(), other = job_specimen();
  same.seconds = 9, same.host = "two", same.date = "later", same.commit = "other";
  other.values["height"] = std::nextafter(1.0 / 3, 1.0);
  JobShard(shard_path(scratch, "a")).end("k1", first, {});
  JobShard(shard_path(scratch, "b")).end("k1", same, {});
  JobIndex index(scratch.file("store"));
  CHECK(index.merge() == 1);
  CHECK(index.repeated() == 1);
  CHECK(index.conflicts().empty());
  JobShard(shard_path(scratch, "c")).end("k1", other, {});
  CHECK(index.merge() == 0);
  CHECK(index.repeated() == 2);
  REQUIRE(index.conflicts().size() == 1);
  CHECK(index.conflicts()[0].key == "k1");
  CHECK(index.conflicts()[0].shard == "batch/c");
}

TEST_CASE("job store: starts without an end are counted, ends and interruptions take them back") {
  const ScratchFolder scratch;
  for (const char* name : {"a", "b", "c"}) {
    JobShard shard(shard_path(scratch, name));
    for (const char* key : {"cut off", "ended", "stopped on request"}) shard.start(key, key);
    shard.end("ended", job_specimen(), {});
    shard.interrupt("stopped on request");
  }
  JobIndex index(scratch.file("store"));
  index.merge();
  CHECK(index.open_starts() == std::map<std::string, int>{{"cut off", 3}});
  CHECK(index.open_starts_in("batch") == std::set<std::string>{"cut off"});
  CHECK(index.open_starts_in("bat").empty());
  const ShardState state = read_shard_state({shard_path(scratch, "a"), shard_path(scratch, "b")});
  CHECK(state.results == std::set<std::string>{"ended"});
  CHECK(state.open_starts == std::map<std::string, int>{{"cut off", 2}});
}

TEST_CASE("job store: an index that is damaged, or of another layout, is made anew") {
  const ScratchFolder scratch;
  const std::string path = scratch.file("store/index.sqlite");
  JobShard(shard_path(scratch, "a")).end("k1", job_specimen(), {});
  std::ofstream(path) << std::string(5000, 'x');
  {
    JobIndex index(scratch.file("store"));
    CHECK(index.merge() == 1);
    CHECK(index.contains("k1"));
  }
  SqliteFile(path).run("update layout set version = 1000");
  JobIndex index(scratch.file("store"));
  CHECK(index.merge() == 1);
  CHECK(index.contains("k1"));
}

TEST_CASE("job store: an index that the disk cannot take says so, and is whole afterwards") {
  const ScratchFolder scratch;
  const std::string store = scratch.file("store");
  JobShard shard(shard_path(scratch, "a"));
  for (int k = 0; k < 400; ++k) shard.end("k" + std::to_string(k), job_specimen(), {});
  JobIndex index(store);
  {
    const SmallFiles limit(fs::file_size(store + "/index.sqlite") + 8192);
    CHECK_THROWS_WITH(index.merge(), Catch::Contains("disk"));
  }
  CHECK(index.merge() == 400);
}

TEST_CASE("job store: two programs may merge at a time") {
  const ScratchFolder scratch;
  for (int k = 0; k < 20; ++k) {
    JobShard shard(shard_path(scratch, "s" + std::to_string(k)));
    for (int i = 0; i < 50; ++i) shard.end("k" + std::to_string(50 * k + i), job_specimen(), {});
  }
  long added[2] = {0, 0};
  {
    std::jthread one([&] { added[0] = JobIndex(scratch.file("store")).merge(); });
    std::jthread two([&] { added[1] = JobIndex(scratch.file("store")).merge(); });
  }
  CHECK(added[0] + added[1] == 1000);
  CHECK(JobIndex(scratch.file("store")).repeated() == 0);
}

TEST_CASE("shard file: a line after a torn one is whole") {
  const ScratchFolder scratch;
  const std::string path = scratch.file("s.jsonl");
  append_text(path, "whole\ntorn");
  std::vector<std::string> lines;
  const auto read = [&](std::uint64_t from) {
    return read_whole_lines(path, from, [&](const std::string& line) { lines.push_back(line); });
  };
  CHECK(read(0) == 6);
  CHECK(lines == std::vector<std::string>{"whole"});
  append_text(path, " no more\n");
  CHECK(read(6) == 19);
  CHECK(lines == std::vector<std::string>{"whole", "torn no more"});
  CHECK_THROWS_WITH(ShardFile("/dev/full").append("x"), Catch::Contains("/dev/full"));
}

TEST_CASE("shard file: a line after one that the disk could not take is whole") {
  const ScratchFolder scratch;
  const std::string path = scratch.file("s.jsonl");
  ShardFile shard(path);
  shard.append("first");
  {
    const SmallFiles limit(9);  // room for three letters more
    CHECK_THROWS_WITH(shard.append("second"), Catch::Contains("the disk is full"));
  }
  shard.append("third");
  std::vector<std::string> lines;
  read_whole_lines(path, 0, [&](const std::string& line) { lines.push_back(line); });
  CHECK(lines == std::vector<std::string>{"first", "sec", "third"});
}

}  // namespace foldproof
