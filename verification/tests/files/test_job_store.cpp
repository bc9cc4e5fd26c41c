// The store of a campaign's jobs: shards are the truth, the index only finds what they say.
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "reference/types.h"
#include "verification/files/job_store.h"
#include "verification/files/sqlite_file.h"
#include "verification/specimens/scratch_folder.h"
#include "verification/tests/files/small_files.h"

namespace foldproof {

namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;
using Starts = std::map<std::string, int>;

JobResult job_specimen() {
  const std::map<std::string, double> values = {
      {"height", 1.0 / 3}, {"lowest", std::nan("")}, {"tiny", 5e-324}};
  return {JobEnd::stopped, "\u00e9",  values,   "00ff",   2.5, 3.25,
          1234567890123,   "kept/k1", "a host", "a date", "c4"};
}

/// A line of a result with this end and nothing else.
std::string line_with(const std::string& key, const std::string& end,
                      const std::string& rest = "") {
  return "{\"result\":\"" + key + "\",\"content\":{\"end\":\"" + end +
         "\",\"reason\":\"\",\"digest\":\"\",\"values\":{}}" + rest + "}\n";
}

struct Store {
  ScratchFolder scratch;
  std::string folder = scratch.file("store"), index = folder + "/index.sqlite";

  /// file: below the folder of batches.
  std::string add(const std::string& file, const std::string& text) const {
    const std::string path = folder + "/batches/" + file;
    fs::create_directories(fs::path(path).parent_path());
    std::ofstream(path, std::ios::app) << text;
    return path;
  }
  std::string add_to_a(const std::string& text) const { return add("batch/shards/a.jsonl", text); }
};

}  // namespace

TEST_CASE("job store: all of a result but the clock is found, by this index and by a new one") {
  const Store store;
  JobResult expected = job_specimen();
  const std::string line =
      R"({"bytes":1234567890123,"clock":3.25,"commit":"c4","content":{"digest":"00ff",)"
      R"("end":"stopped","reason":"é","values":{"height":0.3333333333333333,"lowest":null,)"
      R"("tiny":5e-324}},"date":"a date","host":"a host","kept":"kept/k1","result":"k1",)"
      "\"seconds\":2.5}";
  CHECK(result_line("k1", expected) == line);
  CHECK(start_line("k1", "first \xff") == "{\"label\":\"first \uFFFD\",\"start\":\"k1\"}");
  store.add_to_a(units_line({{"height", "m"}}) + "\n" + line + "\n" +
                 units_line({{"height", "km"}}) + "\n" + line_with("k2", "out of memory"));
  expected.clock = 0;
  for (const bool is_rebuilt : {false, true}) {
    if (is_rebuilt) fs::remove(store.index);
    JobIndex index(store.folder);
    CHECK(index.merge() == 2);
    CHECK(index.units() == Units{{"height", "m"}});
    for (int again = 0; again < 2; ++again)
      CHECK(result_line("k1", index.find("k1").value()) == result_line("k1", expected));
    CHECK(std::isnan(index.find("k1").value().values.at("lowest")));
    CHECK(index.find("k2").value().end == JobEnd::out_of_memory);
    CHECK(!index.find("k3"));
  }
}

TEST_CASE("job store: a torn tail is ignored, and read when it is whole") {
  const Store store;
  const std::string line = line_with("k2", "holds");
  store.add_to_a(line_with("k1", "holds") + line.substr(0, line.size() / 2));
  JobIndex index(store.folder);
  CHECK(index.merge() == 1);
  CHECK(!index.find("k2"));
  store.add_to_a(line.substr(line.size() / 2));
  CHECK((index.merge() == 1 && index.merge() == 0 && index.find("k2")));
  CHECK(index.repeated() == 0);  // the first line was not read again
}

TEST_CASE("job store: invalid lines leave the others to be read") {
  const Store store;
  store.add_to_a(line_with("k1", "holds") + "{\"result\": \"k2\", \"content\": {\"end\": \"ho\n");
  store.add_to_a("{\"result\": \"k3\", \"content\": {\"end\": \"holds\"}}\n[1]\n7\n\n");
  store.add_to_a("{\"start\":\"bad\",\"label\":\"\"}\n");
  for (const char* rest :
       {",\"seconds\":\"x\"", ",\"bytes\":[]", ",\"host\":null", ",\"commit\":7"})
    store.add_to_a(line_with("bad", "holds", rest));
  store.add_to_a(line_with("bad", "no such end"));
  for (const char* bad : {"{\"interrupted\":7}", "{\"start\":7}", "{\"units\":{\"a\":7}}",
                          "{\"units\":7}", "{}", "{\"result\":7}"})
    store.add_to_a(std::string(bad) + "\n");
  store.add_to_a(line_with("good", "holds"));
  JobIndex index(store.folder);
  CHECK(index.merge() == 2);
  CHECK((index.find("k1") && index.find("good")));
  CHECK(index.open_starts() == Starts{{"bad", 1}});
  CHECK(index.units().empty());
}

TEST_CASE("job store: a repetition that finds the same is counted, another one is a conflict") {
  const Store store;
  JobResult same = job_specimen(), other = job_specimen();
  same.seconds = 9, same.host = "two", same.date = "later", same.commit = "other";
  other.values["height"] = std::nextafter(1.0 / 3, 1.0);
  store.add_to_a(result_line("k1", job_specimen()) + "\n");
  for (int twice = 0; twice < 2; ++twice) {
    store.add("batch/shards/b.jsonl", result_line("k1", same) + "\n");
    store.add("batch/shards/d.jsonl", line_with("other", "holds"));
  }
  JobIndex index(store.folder);
  CHECK(index.merge() == 2);
  CHECK((index.repeated() == 2 && index.conflicts().empty()));  // once a shard
  store.add("batch/shards/0003/c.jsonl", result_line("k1", other) + "\n");
  store.add("batch/shards/e.json", line_with("another ending", "holds"));
  store.add("batch/f.jsonl", line_with("beside the shards", "holds"));
  CHECK((index.merge() == 0 && index.repeated() == 3));
  REQUIRE(index.conflicts().size() == 1);
  CHECK((index.conflicts()[0].key == "k1" && index.conflicts()[0].shard == "batch/c"));
  CHECK(index.find("k1").value().values.at("height") == 1.0 / 3);
  for (const char* kept : {"", "first files", "later files"})
    store.add("batch/shards/g.jsonl",
              line_with("k2", "holds", std::string(",\"kept\":\"") + kept + "\""));
  CHECK(index.merge() == 1);
  CHECK(index.find("k2").value().kept == "first files");
}

TEST_CASE("job store: starts without an end are counted, ends and interruptions take them back") {
  const Store store;
  std::vector<std::string> shards;
  for (const char* name : {"a", "b"}) {
    std::string text;
    for (const char* key : {"cut off", "ended", "stopped on request", "cut off"})
      text += start_line(key, "a label") + "\n";
    shards.push_back(store.add(std::string("batch/shards/") + name + ".jsonl", text));
  }
  JobIndex index(store.folder);
  index.merge();
  CHECK(index.open_starts() == Starts{{"cut off", 4}, {"ended", 2}, {"stopped on request", 2}});
  for (const std::string& shard : shards)
    std::ofstream(shard, std::ios::app) << result_line("ended", job_specimen()) + "\n" +
                                               interruption_line("stopped on request") + "\n" +
                                               start_line("torn", "").substr(0, 9);
  index.merge();
  CHECK(index.open_starts() == Starts{{"cut off", 4}});
  shards[1] = "no such file";
  JobIndex of_one(shards);
  CHECK(of_one.open_starts() == Starts{{"cut off", 2}});
  CHECK((of_one.find("ended") && !of_one.find("cut off")));
}

TEST_CASE("job store: an index that is damaged, or of another layout, is made anew") {
  const Store store;
  store.add_to_a(line_with("k1", "holds"));
  JobIndex(store.folder).merge();
  for (const bool is_damaged : {true, false}) {
    if (is_damaged) std::ofstream(store.index) << std::string(5000, 'x');
    if (!is_damaged) SqliteFile(store.index).run("update layout set version = 1000");
    JobIndex index(store.folder);
    CHECK((index.merge() == 1 && index.find("k1")));
  }
}

TEST_CASE("job store: an index that the disk cannot take says so, and is whole afterwards") {
  const Store store;
  for (int k = 0; k < 400; ++k)
    store.add_to_a(result_line("k" + std::to_string(k), job_specimen()) + "\n");
  JobIndex index(store.folder);
  {
    const FileSizeLimit limit(fs::file_size(store.index) + 8192);
    CHECK_THROWS_WITH(index.merge(), Contains("disk"));
  }
  CHECK(index.merge() == 400);
}

}  // namespace foldproof
