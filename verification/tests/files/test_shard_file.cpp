// Shards: files of lines with one writer, and the names that no other process takes.
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <chrono>

#include "verification/files/shard_file.h"
#include "verification/specimens/scratch_folder.h"
#include "verification/tests/files/raw_hdf5.h"

namespace foldproof {

namespace {

using Catch::Equals;

std::vector<std::string> split_from_the_end(const std::string& name, int parts) {
  std::vector<std::string> result;
  std::string rest = name;
  for (int k = 1; k < parts; ++k) {
    const std::size_t at = rest.rfind('-');
    REQUIRE(at != std::string::npos);
    result.insert(result.begin(), rest.substr(at + 1));
    rest.resize(at);
  }
  result.insert(result.begin(), rest);
  return result;
}

}  // namespace

TEST_CASE("shards: a name is made of host, process, microseconds and a count") {
  char host[256] = {};
  gethostname(host, sizeof host - 1);
  CHECK(host_name() == host);
  const auto microseconds = [] {
    return std::chrono::duration_cast<std::chrono::microseconds>(
               std::chrono::system_clock::now().time_since_epoch())
        .count();
  };
  const auto before = microseconds();
  const auto first = split_from_the_end(new_shard_name(), 4),
             second = split_from_the_end(new_shard_name(), 4);
  const auto after = microseconds();
  for (const auto* parts : {&first, &second}) {
    CHECK((*parts)[0] == host);
    CHECK((*parts)[1] == std::to_string(getpid()));
    CHECK(std::stoll((*parts)[2]) >= before);
    CHECK(std::stoll((*parts)[2]) <= after);
  }
  CHECK(std::stoi(second[3]) == std::stoi(first[3]) + 1);
}

TEST_CASE("shards: the file and its folder are made by the first line, and closed at the end") {
  const ScratchFolder scratch;
  const std::string path = scratch.file("a/b/s.jsonl");
  int descriptor = -1;
  {
    ShardFile shard(path);
    CHECK(shard.path() == path);
    CHECK(shard.descriptor() == -1);
    CHECK_NOTHROW(shard.flush_to_disk());
    CHECK_FALSE(std::filesystem::exists(scratch.file("a")));
    shard.append("first");
    descriptor = shard.descriptor();
    CHECK(fcntl(descriptor, F_GETFD) == FD_CLOEXEC);
    shard.append("");
    shard.append("third line");
    CHECK(shard.descriptor() == descriptor);
    CHECK_NOTHROW(shard.flush_to_disk());
    CHECK(bytes_of_file(path) == "first\n\nthird line\n");
  }
  CHECK(fcntl(descriptor, F_GETFD) == -1);
  const mode_t mask = umask(0);
  umask(mask);
  struct stat about = {};
  stat(path.c_str(), &about);
  CHECK((about.st_mode & 07777) == (0666 & ~mask));
  ShardFile(path).append("fourth");
  CHECK(bytes_of_file(path) == "first\n\nthird line\nfourth\n");
}

TEST_CASE("shards: a file that cannot be opened, written or flushed is named with the reason") {
  const ScratchFolder scratch;
  const std::string folder = scratch.file("folder");
  std::filesystem::create_directory(folder);
  ShardFile shard(folder);
  for (const char* line : {"", "a line"})
    CHECK_THROWS_WITH(shard.append(line), Equals(folder + ": cannot be written: Is a directory"));
  CHECK_THROWS_WITH(ShardFile("/dev/full").append("x"),
                    Equals("/dev/full: cannot be written: No space left on device"));
  ShardFile null("/dev/null");  // which cannot be flushed
  null.append("x");
  CHECK_THROWS_WITH(null.flush_to_disk(), Equals("/dev/null: cannot be written: Invalid argument"));
}

TEST_CASE("shards: a program without standard input may get its descriptor, 0") {
  const ScratchFolder scratch;
  const std::string path = scratch.file("s.jsonl");
  const int input = dup(0);
  close(0);
  int first = -1, second = -1, end = 0;
  std::string refusal;
  {
    ShardFile shard(path);
    shard.append("first");
    first = shard.descriptor();
    shard.append("second");
    second = shard.descriptor();
  }
  end = fcntl(0, F_GETFD);
  try {
    ShardFile null("/dev/null");
    null.append("x");
    null.flush_to_disk();
  } catch (const std::runtime_error& error) {
    refusal = error.what();
  }
  if (input >= 0) {
    dup2(input, 0);
    close(input);
  }
  CHECK(first == 0);
  CHECK(second == 0);
  CHECK(end == -1);
  CHECK(bytes_of_file(path) == "first\nsecond\n");
  CHECK(refusal == "/dev/null: cannot be written: Invalid argument");
}

TEST_CASE("shards: a torn line gets its end before the next one, however many writes fail") {
  const ScratchFolder scratch;
  const std::string path = scratch.file("s.jsonl");
  ShardFile shard(path);
  shard.append("first");
  {
    const FileSizeLimit limit(7);  // room for one letter
    CHECK_THROWS_WITH(shard.append("second"),
                      Equals(path + ": cannot be written: the disk is full"));
    CHECK_THROWS_WITH(shard.append("third"), Equals(path + ": cannot be written: File too large"));
  }
  shard.append("fourth");
  shard.append("fifth");
  CHECK(bytes_of_file(path) == "first\ns\nfourth\nfifth\n");
  {
    const FileSizeLimit limit(21);  // no room at all
    CHECK_THROWS_WITH(shard.append("sixth"), Equals(path + ": cannot be written: File too large"));
  }
  shard.append("seventh");
  CHECK(bytes_of_file(path) == "first\ns\nfourth\nfifth\nseventh\n");
}

TEST_CASE("shards: whole lines are read from a byte on, and the next byte is returned") {
  const ScratchFolder scratch;
  const std::string path = scratch.write("s.jsonl", "one\nthree\n\nfour\ntorn");
  std::vector<std::string> lines;
  const auto read = [&](std::uint64_t from) {
    lines.clear();
    return read_whole_lines(path, from, [&](const std::string& line) { lines.push_back(line); });
  };
  CHECK(read(0) == 16);
  CHECK(lines == std::vector<std::string>{"one", "three", "", "four"});
  CHECK(read(4) == 16);
  CHECK(lines == std::vector<std::string>{"three", "", "four"});
  CHECK(read(16) == 16);
  CHECK(lines.empty());
  CHECK(read_whole_lines(scratch.file("missing"), 7,
                         [&](const std::string& line) { lines.push_back(line); }) == 7);
  CHECK(lines.empty());
}

}  // namespace foldproof
