// The store of results, its shards, and files that are complete or absent: what was kept is found,
// what is damaged was never there, and cannot crash its reader.
#include <fcntl.h>
#include <unistd.h>
#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <thread>

#include "reference/types.h"
#include "verification/files/atomic_file.h"
#include "verification/files/isolated_reader.h"
#include "verification/files/result_store.h"
#include "verification/files/shard_file.h"
#include "verification/specimens/scratch_folder.h"
#include "verification/tests/files/small_files.h"

namespace foldproof {

namespace {

using Catch::Matchers::Contains;
namespace fs = std::filesystem;

const StoredResult specimen{{{"x", {1.25, -3e-300, 7}}, {"none", {}}}, {{"why", "a \"word\"\n"}}};

std::vector<fs::path> files_in(const std::string& folder, const std::string& extension) {
  std::vector<fs::path> found;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.path().extension() == extension) found.push_back(entry.path());
  return found;
}

struct Kept {
  ScratchFolder scratch;
  std::string folder = scratch.file("store");
};

/// Of the whole lines from a byte on: each with its end; and the byte after them.
std::string lines_from(std::uint64_t byte, const std::string& path) {
  std::string lines;
  const auto end =
      read_whole_lines(path, byte, [&](const std::string& line) { lines += line + "\n"; });
  return lines + std::to_string(end);
}

/// "PATH: cannot be written (WHY); ..."
auto refusal(const std::string& path, const std::string& why) {
  return Catch::StartsWith(path + ": cannot be written (" + why + ");");
}

/// A file that is there.
struct SmallFile {
  ScratchFolder scratch;
  std::string path = scratch.write("a.txt", "as it was"), partial = path + ".partial";

  void check_untouched() const {
    CHECK(bytes_of_file(path) == "as it was");
    CHECK_FALSE(fs::exists(fs::symlink_status(partial)));
  }  /// The failure that is reported of it when this reads it.
  std::string failure(const std::function<bool()>& read) const {
    return failure_in_isolation(path, read);
  }
};

}  // namespace

TEST_CASE("a run that was started and did not end has no result") {
  const Kept kept;
  fs::create_directory(kept.folder);
  for (int k = 0; k < 3; ++k) ResultStore(kept.folder).start("abc", "cut off");
  fs::copy_file(files_in(kept.folder, ".jsonl").at(0), kept.folder + "/shards/copy.txt");
  const ResultStore store(kept.folder);
  CHECK(store.starts("abc") == 3);
  CHECK((!store.contains("abc") && !store.find("abc").has_value()));
}

TEST_CASE("arrays that cannot be read, or are another length, are no result") {
  const Kept longer;
  ResultStore(longer.folder).keep("abc", {{{"x", {1, 2, 3, 4}}, {"none", {}}}, {}});
  for (const std::string damage : {"no HDF5", "gone", "longer"}) {
    const Kept kept;
    ResultStore(kept.folder).keep("abc", specimen);
    const fs::path arrays = files_in(kept.folder, ".h5").at(0);
    fs::remove(arrays);
    if (damage == "longer") fs::copy_file(files_in(longer.folder, ".h5").at(0), arrays);
    if (damage == "no HDF5") std::ofstream(arrays) << damage;
    ResultStore store(kept.folder);
    CHECK_FALSE(store.find("abc").has_value());
    store.keep("abc", specimen);  // made again
    CHECK((store.find("abc") && ResultStore(kept.folder).find("abc")));
  }
}

TEST_CASE("an earlier copy serves where a later one is damaged") {
  const Kept kept;
  ResultStore(kept.folder).keep("abc", specimen);
  const fs::path first = files_in(kept.folder, ".h5").at(0);
  ResultStore second(kept.folder);
  second.keep("abc", specimen);
  for (const fs::path& arrays : files_in(kept.folder, ".h5"))
    if (arrays != first) fs::remove(arrays);
  CHECK((second.find("abc") && ResultStore(kept.folder).find("abc")));
}

TEST_CASE("two writers of one folder lose nothing and mix nothing") {
  const Kept kept;
  constexpr int results = 40;
  const auto key_of = [](int k, int writer) {
    return (k % 2 ? "shared" : "own" + std::to_string(writer)) + std::to_string(k);
  };
  const auto write = [&](int writer) {
    ResultStore store(kept.folder);
    for (int k = 0; k < results; ++k) {
      store.start(key_of(k, writer), std::string(300, 'x'));
      store.keep(key_of(k, writer), {{{"x", {double(k)}}}, {}});
    }
  };
  std::thread first(write, 1), second(write, 2);
  first.join(), second.join();
  const ResultStore store(kept.folder);
  for (int k = 0; k < results; ++k)
    for (const int writer : {1, 2}) {
      const auto found = store.find(key_of(k, writer));
      REQUIRE(found.has_value());
      CHECK(found->arrays.at("x") == std::vector<double>{double(k)});
      CHECK(store.starts(key_of(k, writer)) == (k % 2 ? 2 : 1));
    }
  CHECK((files_in(kept.folder, ".jsonl").size() == 2 && files_in(kept.folder, ".partial").empty()));
  CHECK(files_in(kept.folder, ".h5").size() == 2 * results);  // each writer has its own
}

TEST_CASE("a store that is a file, or cannot be written, is refused by its name") {
  const Kept kept;
  const std::string path = kept.scratch.write("file", "text");
  CHECK_THROWS_WITH(ResultStore(path), Contains(path) && Contains("folder"));
  CHECK_THROWS_AS(ResultStore(path), InputError);
  fs::create_directory(kept.folder);
  std::ofstream(kept.folder + "/arrays") << "a file where a folder is to be";
  CHECK_THROWS_WITH(ResultStore(kept.folder).keep("abc", specimen), Contains(kept.folder));
}

TEST_CASE("shards: a program without standard input may get its descriptor, 0") {
  const ScratchFolder scratch;
  const std::string path = scratch.file("s.jsonl");
  const int input = dup(0);
  close(0);
  int first = -1;
  {
    ShardFile shard(path);
    shard.append("first");
    first = shard.descriptor();
    CHECK(fcntl(0, F_GETFD) == FD_CLOEXEC);
    shard.append("second");
    CHECK_NOTHROW(shard.flush_to_disk());
  }
  const int end = fcntl(0, F_GETFD);
  {
    ShardFile null("/dev/null");  // which cannot be flushed
    null.append("x");
    CHECK_THROWS_WITH(null.flush_to_disk(), Contains("/dev/null") && Contains("Invalid argument"));
  }
  dup2(input, 0);
  close(input);
  CHECK((first == 0 && end == -1));
  CHECK(bytes_of_file(path) == "first\nsecond\n");
}

TEST_CASE("shard file: a line after a torn one is whole") {
  const ScratchFolder scratch;
  const std::string path = scratch.write("s.jsonl", "one\nthree\n\ntorn");
  CHECK(lines_from(0, path) == "one\nthree\n\n11");
  CHECK(lines_from(4, path) == "three\n\n11");
  CHECK(lines_from(11, path) == "11");
  scratch.write("s.jsonl", "one\nthree\n\ntorn no more\n");
  CHECK(lines_from(11, path) == "torn no more\n24");
  CHECK(lines_from(7, scratch.file("missing")) == "7");
  for (const std::string unwritable : {"/dev/full", "/dev"})
    CHECK_THROWS_WITH(ShardFile(unwritable).append(""), Contains(unwritable));
}

TEST_CASE("shard file: a line after one that the disk could not take is whole") {
  const ScratchFolder scratch;
  const std::string path = scratch.file("s.jsonl");
  ShardFile shard(path);
  shard.append("first");
  {
    const FileSizeLimit limit(9);  // room for three letters more
    CHECK_THROWS_WITH(shard.append("second"), Contains(path) && Contains("the disk is full"));
    CHECK_THROWS_WITH(shard.append("third"), Contains(path) && Contains("File too large"));
  }
  shard.append("fourth");
  shard.append("fifth");
  CHECK(bytes_of_file(path) == "first\nsec\nfourth\nfifth\n");
}

TEST_CASE("atomic file: a text replaces what was there, and leaves no other file") {
  const SmallFile file;
  file.scratch.write("a.txt.partial", "what a crash left, which was longer, too");
  const FileSizeLimit limit(100'000);  // what writes without end stops soon
  const std::string text("some \0 text\n\xff", 13);
  for (const std::string& one : {text, std::string()}) {
    write_text(file.path, one);
    CHECK(bytes_of_file(file.path) == one);
    CHECK_FALSE(fs::exists(file.partial));
  }
}

TEST_CASE("atomic file: a text that is not on the disk for certain leaves what was there") {
  const SmallFile file;
  {
    const FileSizeLimit limit(1000);
    CHECK_THROWS_WITH(write_text(file.path, std::string(3000, 'x')),
                      refusal(file.path, "File too large"));
    file.check_untouched();
    CHECK_NOTHROW(write_text(file.scratch.file("b"), std::string(1000, 'y')));
  }
  for (const auto& [device, why] : {std::pair("/dev/full", "No space left on device"),
                                    {"/dev/null", "Invalid argument"}}) {  // it keeps nothing
    fs::create_symlink(device, file.partial);
    CHECK_THROWS_WITH(write_text(file.path, "new"), refusal(file.path, why));
    file.check_untouched();
  }
  const std::string pipe = file.scratch.file("pipe"), folder = file.scratch.file("folder");
  CHECK_THROWS_WITH(durable_rename(pipe, file.path),
                    refusal(file.path, "No such file or directory"));
  fs::create_symlink("/dev/null", pipe);
  CHECK_THROWS_WITH(durable_rename(pipe, file.path), refusal(file.path, "Invalid argument"));
  file.check_untouched();
  fs::create_directories(folder + "/full");
  CHECK_THROWS_WITH(write_text(folder, "x"), refusal(folder, "Is a directory"));
  fs::remove(pipe);
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  for (const std::string& good : {file.path, file.scratch.file("nothing")})
    CHECK_NOTHROW(require_replaceable(good));
  for (const std::string& other : {folder, pipe})
    CHECK_THROWS_WITH(require_replaceable(other), Contains(other) && Contains("is no file"));
}

TEST_CASE("isolated reader: it reports what the reader says, and how the reader ended") {
  const SmallFile file;
  bool was_called = false;
  const auto read = [&] { return was_called = true; };
  CHECK(file.failure(read) == "");
  CHECK(failure_in_isolation(file.partial, read) == "it is not there");
  const std::string folder = file.scratch.file("");
  CHECK_THROWS_WITH(failure_in_isolation(folder, read), Contains(folder + ": cannot be read"));
  CHECK_THROWS_AS(failure_in_isolation(folder, read), InputError);
  CHECK_FALSE(was_called);  // in another process
  CHECK(file.failure([] { return false; }) == "it is damaged");
  CHECK(file.failure([]() -> bool { throw 7; }) == "it is damaged");
  for (const int signal : {SIGKILL, SIGUSR1})
    CHECK(file.failure([&] { return std::raise(signal) == 0; }) ==
          "it is damaged: reading it ended with signal " + std::to_string(signal));
}

}  // namespace foldproof
