// The store of results: what was kept is found, what is damaged was never there.
#include <catch2/catch.hpp>
#include <atomic>
#include <filesystem>
#include <fstream>
#include <thread>

#include "reference/types.h"
#include "verification/files/result_store.h"
#include "verification/specimens/scratch_folder.h"

namespace foldproof {

using Catch::Matchers::Contains;

namespace {

namespace fs = std::filesystem;

const StoredResult specimen{{{"x", {1.25, -3e-300, 7}}, {"none", {}}}, {{"why", "a \"word\"\n"}}};

std::vector<fs::path> files_in(const std::string& folder, const std::string& extension) {
  std::vector<fs::path> found;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.path().extension() == extension) found.push_back(entry.path());
  return found;
}

}  // namespace

TEST_CASE("a result is found again, by this store and by the next") {
  const ScratchFolder scratch;
  const std::string folder = scratch.file("store");
  ResultStore store(folder);
  CHECK_FALSE(fs::exists(folder));
  CHECK_FALSE(store.find("abc").has_value());
  CHECK_FALSE(store.contains("abc"));
  store.start("abc", "first");
  store.keep("abc", specimen);
  const ResultStore next(folder);
  for (const ResultStore* one : {&std::as_const(store), &next}) {
    const auto found = one->find("abc");
    REQUIRE(found);
    CHECK(found->arrays.at("x") == specimen.arrays.at("x"));
    CHECK(found->texts == specimen.texts);
    CHECK(one->starts("abc") == 1);
    CHECK(one->contains("abc"));
    CHECK_FALSE(one->find("abd").has_value());
  }
}

TEST_CASE("a store without a folder keeps nothing") {
  ResultStore store;
  store.start("abc", "x");
  store.keep("abc", specimen);
  CHECK_FALSE(store.find("abc").has_value());
  CHECK(store.starts("abc") == 0);
}

TEST_CASE("a run that was started and did not end has no result") {
  const ScratchFolder scratch;
  const std::string folder = scratch.file("store");
  for (int k = 0; k < 3; ++k) ResultStore(folder).start("abc", "cut off");
  const ResultStore store(folder);
  CHECK(store.starts("abc") == 3);
  CHECK_FALSE(store.contains("abc"));
  CHECK_FALSE(store.find("abc").has_value());
}

TEST_CASE("a torn last line, and lines of others, are as if they were not there") {
  const ScratchFolder scratch;
  const std::string folder = scratch.file("store");
  ResultStore(folder).keep("abc", specimen);
  {
    std::ofstream shard(files_in(folder, ".jsonl").at(0), std::ios::app);
    shard << "[1]\n5\nnull\n{\"start\": 5}\n{\"result\": {}}\n{\"result\": \"abe\"}\n"
          << "{\"result\": \"abf\", \"texts\": 7, \"arrays\": {}}\n"
          << "{\"result\": \"abg\", \"texts\": {}, \"arrays\": {\"x\": \"y\"}}\n"
          << "{\"result\": \"abd\", \"texts\": {\"why";
  }
  const ResultStore store(folder);
  CHECK(store.find("abc").has_value());
  for (const char* key : {"abd", "abe", "abf", "abg", "5"}) {
    CHECK_FALSE(store.contains(key));
    CHECK(store.starts(key) == 0);
  }
}

TEST_CASE("arrays that cannot be read, or are another length, are no result") {
  for (const char* damage : {"", "no HDF5 at all", "gone"}) {
    const ScratchFolder scratch;
    const std::string folder = scratch.file("store");
    ResultStore(folder).keep("abc", specimen);
    const fs::path arrays = files_in(folder, ".h5").at(0);
    if (std::string(damage) == "gone")
      fs::remove(arrays);
    else
      std::ofstream(arrays) << damage;
    ResultStore store(folder);
    CHECK_FALSE(store.find("abc").has_value());
    store.keep("abc", specimen);  // made again
    CHECK(store.find("abc").has_value());
    CHECK(ResultStore(folder).find("abc").has_value());
  }
  const ScratchFolder scratch;
  const std::string folder = scratch.file("store");
  ResultStore(folder).keep("abc", {{{"x", {1, 2}}}, {}});
  const fs::path shorter = files_in(folder, ".h5").at(0);
  const std::string other = scratch.file("other");
  ResultStore(other).keep("abc", {{{"x", {1}}}, {}});
  fs::copy_file(files_in(other, ".h5").at(0), shorter, fs::copy_options::overwrite_existing);
  CHECK_FALSE(ResultStore(folder).find("abc").has_value());
}

TEST_CASE("an earlier copy serves where a later one is damaged") {
  const ScratchFolder scratch;
  const std::string folder = scratch.file("store");
  ResultStore(folder).keep("abc", specimen);
  const fs::path first = files_in(folder, ".h5").at(0);
  ResultStore second(folder);
  second.keep("abc", specimen);
  for (const fs::path& arrays : files_in(folder, ".h5"))
    if (arrays != first) fs::remove(arrays);
  CHECK(second.find("abc").has_value());
  CHECK(ResultStore(folder).find("abc").has_value());
}

TEST_CASE("two writers of one folder lose nothing and mix nothing") {
  const ScratchFolder scratch;
  const std::string folder = scratch.file("store");
  constexpr int results = 40;
  std::atomic<int> failed = 0;
  const auto write = [&](int writer) {
    ResultStore store(folder);
    for (int k = 0; k < results; ++k) try {
        const std::string key =
            (k % 2 ? "shared" : "own" + std::to_string(writer)) + std::to_string(k);
        store.start(key, std::string(300, 'x'));
        store.keep(key, {{{"x", {double(k)}}}, {}});
      } catch (const std::exception&) {
        ++failed;
      }
  };
  std::thread first(write, 1), second(write, 2);
  first.join();
  second.join();
  CHECK(failed == 0);
  const ResultStore store(folder);
  for (int k = 0; k < results; ++k)
    for (const std::string writer : {"1", "2"}) {
      const std::string key = (k % 2 ? std::string("shared") : "own" + writer) + std::to_string(k);
      REQUIRE(store.find(key).has_value());
      CHECK(store.find(key)->arrays.at("x") == std::vector<double>{double(k)});
      CHECK(store.starts(key) == (k % 2 ? 2 : 1));
    }
  CHECK(files_in(folder, ".jsonl").size() == 2);
  CHECK(files_in(folder, ".partial").empty());
  CHECK(files_in(folder, ".h5").size() == 2 * results);  // each writer has its own
}

TEST_CASE("a store may be used by several threads") {
  const ScratchFolder scratch;
  ResultStore store(scratch.file("store"));
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t)
    threads.emplace_back([&store, t] {
      for (int k = 0; k < 10; ++k) {
        const std::string key = "key" + std::to_string(10 * t + k);
        store.start(key, "");
        store.keep(key, {{{"x", {double(t), double(k)}}}, {}});
      }
    });
  for (std::thread& thread : threads) thread.join();
  for (int n = 0; n < 40; ++n)
    CHECK(store.find("key" + std::to_string(n))->arrays.at("x") ==
          std::vector<double>{double(n / 10), double(n % 10)});
}

TEST_CASE("a store that is a file, or cannot be written, is refused by its name") {
  const ScratchFolder scratch;
  const std::string path = scratch.file("store");
  std::ofstream(path) << "a file";
  CHECK_THROWS_WITH(ResultStore(path), Contains(path) && Contains("folder"));
  CHECK_THROWS_AS(ResultStore(path), InputError);
  const std::string blocked = scratch.file("blocked");
  fs::create_directory(blocked);
  std::ofstream(blocked + "/arrays") << "a file where a folder is to be";
  ResultStore store(blocked);
  CHECK_THROWS_WITH(store.keep("abc", specimen), Contains(blocked));
  CHECK_FALSE(store.contains("abc"));
}

}  // namespace foldproof
