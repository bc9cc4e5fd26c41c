// The lines of a campaign's shards: what is written, and what each says to the index.
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "reference/types.h"
#include "verification/files/job_store.h"
#include "verification/specimens/scratch_folder.h"

namespace foldproof {

namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;

/// Every entry has a value of its own.
JobResult full_result() {
  return {JobEnd::stopped, "diverged", {{"height", 0.75}, {"lowest", std::nan("")}},
          "00ff",          2.5,        3.25,
          1234567890123,   "kept/k1",  "a host",
          "a date",        "c4"};
}

const char* const full_line =
    R"({"bytes":1234567890123,"clock":3.25,"commit":"c4","content":{"digest":"00ff",)"
    R"("end":"stopped","reason":"diverged","values":{"height":0.75,"lowest":null}},)"
    R"("date":"a date","host":"a host","kept":"kept/k1","result":"k1","seconds":2.5})";

/// A line of a result with this end and nothing else.
std::string line_with(const std::string& key, const std::string& end,
                      const std::string& rest = "") {
  return "{\"result\":\"" + key + "\",\"content\":{\"end\":\"" + end +
         "\",\"reason\":\"\",\"digest\":\"\",\"values\":{}}" + rest + "}\n";
}

std::string text_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The store of a scratch folder, with shards of these texts in the batch "b".
struct Store {
  ScratchFolder scratch;
  std::string folder = scratch.file("store");

  std::string shard(const std::string& name) const {
    return folder + "/batches/b/shards/" + name + ".jsonl";
  }
  void add(const std::string& name, const std::string& text) const {
    fs::create_directories(fs::path(shard(name)).parent_path());
    std::ofstream(shard(name), std::ios::app) << text;
  }
};

}  // namespace

TEST_CASE("job lines: a shard is written as its header says, units once") {
  const ScratchFolder scratch;
  JobShard shard(scratch.file("s/a.jsonl"));
  CHECK(shard.descriptor() == -1);
  shard.start("k1", "first \xff");
  CHECK(shard.descriptor() >= 0);
  shard.end("k1", full_result(), {{"height", "m"}, {"lowest", "mm"}});
  shard.interrupt("k2");
  shard.end("k1", full_result(), {{"height", "km"}, {"speed", "m/s"}});
  shard.end("k1", full_result(), {{"height", "m"}});
  const std::string line = full_line;
  CHECK(text_of(scratch.file("s/a.jsonl")) ==
        "{\"label\":\"first \uFFFD\",\"start\":\"k1\"}\n"
        "{\"units\":{\"height\":\"m\",\"lowest\":\"mm\"}}\n" +
            line + "\n{\"interrupted\":\"k2\"}\n{\"units\":{\"speed\":\"m/s\"}}\n" + line + "\n" +
            line + "\n");
  CHECK(JobShard::line_of("k1", full_result()) == line + "\n");
}

TEST_CASE("job lines: a result of which nothing is known is written with zeros and no texts") {
  CHECK(JobShard::line_of("k", {}) ==
        R"({"bytes":0,"clock":0.0,"commit":"","content":{"digest":"","end":"holds",)"
        R"("reason":"","values":{}},"date":"","host":"","kept":"","result":"k","seconds":0.0})"
        "\n");
}

TEST_CASE("job lines: text other than ASCII stays as it is") {
  JobResult result;
  result.reason = "\u00e9";
  CHECK_THAT(JobShard::line_of("k", result), Contains("\"reason\":\"\u00e9\""));
}

TEST_CASE("job lines: a shard that cannot be put on the disk says so") {
  JobShard shard("/dev/null");
  shard.interrupt("k");
  CHECK_THROWS_WITH(shard.flush_to_disk(), Contains("/dev/null"));
}

TEST_CASE("job lines: each end of a job has a name, by which it is read again") {
  const Store store;
  const std::pair<JobEnd, const char*> ends[] = {
      {JobEnd::holds, "holds"},         {JobEnd::fails, "fails"},
      {JobEnd::stopped, "stopped"},     {JobEnd::refused, "refused"},
      {JobEnd::timed_out, "timed out"}, {JobEnd::out_of_memory, "out of memory"}};
  REQUIRE(job_ends().size() == 6);
  JobShard shard(store.shard("a"));
  for (size_t k = 0; k < 6; ++k) {
    CHECK(job_ends()[k] == ends[k].first);
    CHECK(name_of(ends[k].first) == ends[k].second);
    JobResult result;
    result.end = ends[k].first;
    shard.end(ends[k].second, result, {});
  }
  JobIndex index(store.folder);
  CHECK(index.merge() == 6);
  for (const auto& [end, name] : ends) CHECK(index.find(name).value().end == end);
}

TEST_CASE("job lines: the index finds all of a result but the clock") {
  const Store store;
  store.add("a", std::string(full_line) + "\n" + line_with("k2", "fails"));
  JobIndex index(store.folder);
  CHECK(index.merge() == 2);
  SqliteFile database(store.folder + "/index.sqlite");
  SqliteQuery row = database.query("select end, program from results where key = 'k1'");
  REQUIRE(row.next());
  CHECK(row.text(0) == "stopped");
  CHECK(row.text(1) == "c4");
  row.reset();
  for (int again = 0; again < 2; ++again) {
    const JobResult found = index.find("k1").value();
    CHECK(found.end == JobEnd::stopped);
    CHECK(found.reason == "diverged");
    CHECK(found.digest == "00ff");
    REQUIRE(found.values.size() == 2);
    CHECK(found.values.at("height") == 0.75);
    CHECK(std::isnan(found.values.at("lowest")));
    CHECK(found.seconds == 2.5);
    CHECK(found.bytes == 1234567890123);
    CHECK(found.kept == "kept/k1");
    CHECK(found.host == "a host");
    CHECK(found.date == "a date");
    CHECK(found.commit == "c4");
    CHECK(index.find("k2").value().end == JobEnd::fails);
    CHECK(index.contains("k2"));
    CHECK(index.contains("k1"));
    CHECK_FALSE(index.find("k3").has_value());
    CHECK_FALSE(index.contains("k3"));
  }
}

TEST_CASE("job lines: a result that says nothing of its run is read with zeros and no texts") {
  const Store store;
  store.add("a", line_with("k", "holds"));
  JobIndex index(store.folder);
  CHECK(index.merge() == 1);
  const JobResult found = index.find("k").value();
  CHECK(found.seconds == 0);
  CHECK(found.bytes == 0);
  CHECK((found.kept + found.host + found.date + found.commit) == "");
}

TEST_CASE("job lines: an invalid line of a result leaves the others to be read") {
  const Store store;
  const std::string good = line_with("good", "holds");
  for (const std::string& bad :
       {line_with("bad", "no such end"), line_with("bad", "holds", ",\"seconds\":\"x\""),
        line_with("bad", "holds", ",\"bytes\":[]"), line_with("bad", "holds", ",\"host\":null"),
        line_with("bad", "holds", ",\"commit\":7"), std::string("{\"interrupted\":7}\n"),
        std::string("{\"start\":7}\n"), std::string("{\"units\":{\"a\":7}}\n"),
        std::string("{\"units\":7}\n"), std::string("{}\n"), std::string("{\"result\":7}\n")})
    store.add("a", bad);
  store.add("a", good);
  JobIndex index(store.folder);
  CHECK(index.merge() == 1);
  CHECK(index.contains("good"));
  CHECK_FALSE(index.contains("bad"));
  CHECK(index.open_starts().empty());
  CHECK(index.units().empty());
}

TEST_CASE("job lines: an invalid result leaves its job unfinished") {
  const Store store;
  store.add("a", "{\"start\":\"k\",\"label\":\"\"}\n" + line_with("k", "no such end"));
  JobIndex index(store.folder);
  CHECK(index.merge() == 0);
  CHECK(index.open_starts() == std::map<std::string, int>{{"k", 1}});
}

TEST_CASE("job lines: the first unit of a name counts") {
  const Store store;
  store.add("a",
            "{\"units\":{\"height\":\"m\",\"speed\":\"m/s\"}}\n{\"units\":{\"height\":\"km\"}}\n");
  JobIndex index(store.folder);
  CHECK(index.merge() == 0);
  CHECK(index.units() == Units{{"height", "m"}, {"speed", "m/s"}});
}

TEST_CASE("job lines: a slice's shards tell its results and what was cut off") {
  const Store store;
  store.add("a",
            "{\"start\":\"first\"}\n{\"start\":\"ended\"}\n{\"start\":\"ended\"}\n"
            "{\"start\":\"stopped\"}\n{\"interrupted\":\"stopped\"}\n{\"start\":\"twice\"}\n"
            "{\"result\":\"ended\"}\n{\"result\":\"never started\"}\n[1]\n7\nno JSON\n\n"
            "{\"start\":5}\n{\"result\":5}\n{\"interrupted\":[]}\n{\"other\":\"key\"}\n");
  store.add("b", "{\"start\":\"twice\"}\n{\"start\":\"last");
  const ShardState state =
      read_shard_state({store.shard("a"), store.shard("b"), store.shard("missing")});
  CHECK(state.results == std::set<std::string>{"ended", "never started"});
  CHECK(state.open_starts == std::map<std::string, int>{{"first", 1}, {"ended", 1}, {"twice", 2}});
}

}  // namespace foldproof
