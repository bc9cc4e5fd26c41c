// Where the store of results keeps what, and which of several results it finds.
#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <filesystem>
#include <fstream>

#include "verification/files/hdf5_file.h"
#include "verification/files/result_store.h"
#include "verification/specimens/scratch_folder.h"

namespace foldproof {

namespace {

namespace fs = std::filesystem;

std::vector<fs::path> files_in(const std::string& folder) {
  std::vector<fs::path> found;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) found.push_back(entry.path());
  return found;
}

/// The only file below a folder.
fs::path only_file_in(const std::string& folder) {
  const std::vector<fs::path> found = files_in(folder);
  REQUIRE(found.size() == 1);
  return found[0];
}

std::string text_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

TEST_CASE("result lines: a shard has a line for each start and each result, as it is documented") {
  const ScratchFolder scratch;
  const std::string folder = scratch.file("store");
  ResultStore store(folder);
  store.start("abcd", "first \xff");
  store.keep("abcd", {{{"x", {0.5, 1.5, 2.5}}, {"none", {}}, {"y", {7.5}}}, {{"why", "\u00e9"}}});
  const fs::path shard = only_file_in(folder + "/shards");
  CHECK(shard.extension() == ".jsonl");
  CHECK(text_of(shard) ==
        "{\"label\":\"first \uFFFD\",\"start\":\"abcd\"}\n"
        "{\"arrays\":{\"x\":3,\"y\":1},\"result\":\"abcd\",\"texts\":{\"why\":\"\u00e9\"}}\n");
  const fs::path arrays = only_file_in(folder + "/arrays");
  CHECK(arrays == folder + "/arrays/ab/abcd-" + shard.stem().string() + ".h5");
  const Hdf5 file = Hdf5::open_file(arrays);
  CHECK(file.read_doubles("x") == std::vector<double>{0.5, 1.5, 2.5});
  CHECK(file.read_doubles("y") == std::vector<double>{7.5});
  CHECK_FALSE(file.has("none"));
}

TEST_CASE("result lines: a result without arrays has its texts") {
  const ScratchFolder scratch;
  const std::string folder = scratch.file("store");
  ResultStore(folder).keep("k1", {{}, {{"a", "b"}}});
  const StoredResult found = ResultStore(folder).find("k1").value();
  CHECK(found.arrays.empty());
  CHECK(found.texts == std::map<std::string, std::string>{{"a", "b"}});
}

TEST_CASE("result lines: the latest result of a key is found, by this store and by the next") {
  const ScratchFolder scratch;
  const std::string folder = scratch.file("store");
  const auto age = std::chrono::hours(1);
  std::vector<fs::path> known;
  for (int k = 0; k < 5; ++k) {
    ResultStore store(folder);
    store.keep("key", {{{"x", {double(k), 0.5}}}, {{"k", std::to_string(k)}}});
    store.start("key", "again");
    CHECK(store.find("key").value().arrays.at("x") == std::vector<double>{double(k), 0.5});
    CHECK(store.starts("key") == k + 1);
    for (const fs::path& path : files_in(folder + "/shards"))
      if (std::find(known.begin(), known.end(), path) == known.end()) {
        known.push_back(path);
        // of the five the second is made the youngest
        fs::last_write_time(path, fs::file_time_type::clock::now() - age * (k == 1 ? 1 : 9 - k));
      }
  }
  REQUIRE(known.size() == 5);
  const ResultStore next(folder);
  CHECK(next.find("key").value().texts.at("k") == "1");
  CHECK(next.find("key").value().arrays.at("x") == std::vector<double>{1, 0.5});
  CHECK(next.starts("key") == 5);
}

TEST_CASE("result lines: files of another ending are no shards") {
  const ScratchFolder scratch;
  const std::string folder = scratch.file("store");
  ResultStore(folder).start("key", "");
  const fs::path shard = only_file_in(folder + "/shards");
  fs::copy_file(shard, folder + "/shards/copy.txt");
  CHECK(ResultStore(folder).starts("key") == 1);
  fs::copy_file(shard, folder + "/shards/copy.jsonl");
  CHECK(ResultStore(folder).starts("key") == 2);
}

TEST_CASE("result lines: a line may start a run and give a result") {
  const ScratchFolder scratch;
  const std::string folder = scratch.file("store");
  fs::create_directories(folder + "/shards");
  std::ofstream(folder + "/shards/a.jsonl")
      << "no JSON\n{\"other\":1}\n{\"start\":\"s\",\"result\":\"r\",\"texts\":{},\"arrays\":{}}\n";
  const ResultStore store(folder);
  CHECK(store.starts("s") == 1);
  CHECK(store.contains("r"));
  CHECK_FALSE(store.contains("s"));
  CHECK(store.starts("r") == 0);
}

TEST_CASE("result lines: a folder without shards, or without a name, is empty") {
  const ScratchFolder scratch;
  const std::string folder = scratch.file("store");
  fs::create_directory(folder);
  ResultStore store(folder);
  CHECK_FALSE(store.contains("key"));
  store.start("key", "");
  CHECK(ResultStore(folder).starts("key") == 1);
  ResultStore nameless("");
  nameless.start("key", "");
  CHECK(nameless.starts("key") == 0);
}

}  // namespace foldproof
