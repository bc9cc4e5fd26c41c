// Files that are complete or absent, and the reader that a damaged file cannot crash.
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stop_token>
#include <thread>

#include "reference/types.h"
#include "verification/files/atomic_file.h"
#include "verification/files/isolated_reader.h"
#include "verification/specimens/scratch_folder.h"
#include "verification/tests/files/small_files.h"

namespace foldproof {

namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;

std::string text_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

long open_files() {
  long count = 0;
  for (const auto& one : fs::directory_iterator("/proc/self/fd")) count += !one.path().empty();
  return count;
}

/// "PATH: cannot be written (WHY); ..."
std::string refusal(const std::string& path, const std::string& why) {
  return path + ": cannot be written (" + why +
         "); are its folder and the space left as they should be?";
}

rlim_t limit_of(decltype(RLIMIT_CPU) what) {
  struct rlimit now = {};
  getrlimit(what, &now);
  return now.rlim_cur;
}

}  // namespace

TEST_CASE("atomic file: a text replaces what was there, and leaves no other file") {
  const ScratchFolder scratch;
  const std::string path = scratch.write("a.txt", "what was there before, and was longer");
  scratch.write("a.txt.partial", "what a crash left, which was longer, too");
  const SmallFiles limit(100'000);  // what writes without end stops soon
  const long before = open_files();
  const std::string text("some \0 text\n\xff", 13);
  write_text(path, text);
  CHECK(text_of(path) == text);
  CHECK_FALSE(fs::exists(path + ".partial"));
  write_text(path, "");
  CHECK(text_of(path) == "");
  CHECK(open_files() == before);
}

TEST_CASE("atomic file: a new file may be read and written by those whom the mask allows") {
  const ScratchFolder scratch;
  const mode_t before = umask(0);
  write_text(scratch.file("a"), "text");
  umask(before);
  struct stat status = {};
  REQUIRE(stat(scratch.file("a").c_str(), &status) == 0);
  CHECK((status.st_mode & 07777) == 0666);
}

TEST_CASE("atomic file: a text that does not fit on the disk leaves what was there") {
  const ScratchFolder scratch;
  const std::string path = scratch.write("a.txt", "as it was");
  const long before = open_files();
  {
    const SmallFiles limit(1000);
    CHECK_THROWS_WITH(write_text(path, std::string(3000, 'x')), refusal(path, "File too large"));
    CHECK_FALSE(fs::exists(path + ".partial"));
    CHECK(text_of(path) == "as it was");
    CHECK_NOTHROW(write_text(path, std::string(1000, 'y')));
  }
  CHECK(text_of(path) == std::string(1000, 'y'));
  fs::create_symlink("/dev/full", path + ".partial");
  CHECK_THROWS_WITH(write_text(path, "new"), refusal(path, "No space left on device"));
  CHECK_FALSE(fs::is_symlink(path + ".partial"));
  CHECK(text_of(path) == std::string(1000, 'y'));
  CHECK(open_files() == before);
}

TEST_CASE("atomic file: a text that cannot be put on the disk for certain is not there") {
  const ScratchFolder scratch;
  const std::string path = scratch.file("a.txt");
  fs::create_symlink("/dev/null", path + ".partial");  // takes all, and keeps nothing
  CHECK_THROWS_WITH(write_text(path, "new"), refusal(path, "Invalid argument"));
  CHECK_FALSE(fs::is_symlink(path + ".partial"));
  CHECK_FALSE(fs::is_symlink(path));
}

TEST_CASE("atomic file: a file that cannot be made, or not be replaced, is named with the reason") {
  const ScratchFolder scratch;
  const std::string none = scratch.file("none/a.txt"), folder = scratch.file("folder");
  CHECK_THROWS_WITH(write_text(none, "x"), refusal(none, "No such file or directory"));
  fs::create_directories(folder + "/full");
  CHECK_THROWS_WITH(write_text(folder, "x"), refusal(folder, "Is a directory"));
  CHECK(fs::is_directory(folder));
}

TEST_CASE("atomic file: a file gets its name when it is on the disk") {
  const ScratchFolder scratch;
  const std::string from = scratch.write("from", "text"), to = scratch.file("to");
  const long before = open_files();
  durable_rename(from, to);
  CHECK(text_of(to) == "text");
  CHECK_FALSE(fs::exists(from));
  CHECK_THROWS_WITH(durable_rename(from, to), refusal(to, "No such file or directory"));
  CHECK(text_of(to) == "text");
  fs::create_symlink("/dev/null", from);
  CHECK_THROWS_WITH(durable_rename(from, to), refusal(to, "Invalid argument"));
  CHECK(text_of(to) == "text");
  CHECK(open_files() == before);
}

TEST_CASE("atomic file: a program without standard input can write, too") {
  const ScratchFolder scratch;
  const std::string path = scratch.file("a.txt");
  const int input = dup(STDIN_FILENO);
  close(STDIN_FILENO);  // the next file that is opened has the number 0
  std::string failure;
  try {
    write_text(path, "text");
  } catch (const std::exception& error) {
    failure = error.what();
  }
  const bool is_closed_again = fcntl(STDIN_FILENO, F_GETFD) < 0;
  dup2(input, STDIN_FILENO);
  close(input);
  CHECK(failure == "");
  CHECK(is_closed_again);
  CHECK(text_of(path) == "text");
}

TEST_CASE("atomic file: a write that a signal interrupts goes on where it was") {
  const ScratchFolder scratch;
  const std::string path = scratch.file("a.txt"), pipe = path + ".partial";
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  struct sigaction interrupt = {}, before = {};
  interrupt.sa_handler = [](int) {};
  sigaction(SIGUSR1, &interrupt, &before);
  std::string text, read_there;
  for (int k = 0; k < 60'000; ++k) text += std::to_string(k);  // more than a pipe holds
  const int from = open(pipe.c_str(), O_RDONLY | O_NONBLOCK);
  {
    const std::jthread reader([&, writer = pthread_self()](const std::stop_token& stop) {
      std::string some(70'000, ' ');
      for (ssize_t count = 0; !stop.stop_requested() || count > 0;) {
        for (int twice = 0; twice < 2; ++twice) {  // the second time nothing of it is written
          usleep(2000);
          pthread_kill(writer, SIGUSR1);
        }
        count = read(from, some.data(), some.size());
        if (count > 0) read_there.append(some, 0, size_t(count));
        if (read_there.size() > text.size()) break;  // an endless writer finds no reader
      }
      close(from);
    });
    CHECK_THROWS_WITH(write_text(path, text), refusal(path, "Invalid argument"));  // it is a pipe
  }
  sigaction(SIGUSR1, &before, nullptr);
  CHECK((read_there == text));
}

TEST_CASE("atomic file: only a file, or nothing, can be replaced") {
  const ScratchFolder scratch;
  const std::string file = scratch.write("file", "text"), pipe = scratch.file("pipe");
  const std::string folder = scratch.file("folder"), link = scratch.file("link");
  fs::create_directory(folder);
  fs::create_symlink(file, link);
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  CHECK_NOTHROW(require_replaceable(file));
  CHECK_NOTHROW(require_replaceable(link));
  CHECK_NOTHROW(require_replaceable(scratch.file("nothing")));
  for (const std::string& other : {folder, pipe})
    CHECK_THROWS_WITH(require_replaceable(other),
                      other + ": cannot be written: what is there is no file");
}

TEST_CASE("isolated reader: it reports what the reader says, and how the reader ended") {
  const ScratchFolder scratch;
  const std::string path = scratch.write("a", "text");
  CHECK(failure_in_isolation(path, [] { return true; }) == "");
  CHECK(failure_in_isolation(path, [] { return false; }) == "it is damaged");
  CHECK(failure_in_isolation(path, []() -> bool { throw std::runtime_error("x"); }) ==
        "it is damaged");
  CHECK(failure_in_isolation(path, []() -> bool { throw 7; }) == "it is damaged");
  const std::string killed = "it is damaged: reading it ended with signal ";
  CHECK(failure_in_isolation(path, [] { return std::raise(SIGKILL) == 0; }) == killed + "9");
  CHECK(failure_in_isolation(path, [] { return std::raise(SIGUSR1) == 0; }) == killed + "10");
}

TEST_CASE("isolated reader: what is no file is not read") {
  const ScratchFolder scratch;
  bool was_called = false;
  const auto read = [&] { return was_called = true; };
  CHECK(failure_in_isolation(scratch.file("none"), read) == "it is not there");
  const std::string folder = scratch.file("");
  CHECK_THROWS_WITH(failure_in_isolation(folder, read),
                    folder + ": cannot be read; give a regular file");
  CHECK_THROWS_AS(failure_in_isolation(folder, read), InputError);
  const std::string path = scratch.write("a", "text");
  CHECK(failure_in_isolation(path, read) == "");
  CHECK_FALSE(was_called);  // in another process
}

TEST_CASE("isolated reader: a file gets time and memory by its size, and leaves no core") {
  const ScratchFolder scratch;
  const std::string path = scratch.write("a", "text");
  fs::resize_file(path, 57'000'000);  // 5 s more
  struct rlimit core = {};
  getrlimit(RLIMIT_CORE, &core);
  const struct rlimit largest = {core.rlim_max, core.rlim_max};
  setrlimit(RLIMIT_CORE, &largest);
  CHECK(failure_in_isolation(path, [] { return limit_of(RLIMIT_CORE) == 0; }) == "");
  setrlimit(RLIMIT_CORE, &core);
  const rlim_t seconds = std::min<rlim_t>(limit_of(RLIMIT_CPU), 25);
  CHECK(failure_in_isolation(path, [&] { return limit_of(RLIMIT_CPU) == seconds; }) == "");
  const auto memory_is_limited = [] {
    rlim_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    const auto used = double(pages) * double(sysconf(_SC_PAGESIZE));
    const double allowed = double(limit_of(RLIMIT_AS)) - used;
    return std::abs(allowed - (1073741824.0 + 2 * 57e6)) < 3e6;
  };
  CHECK(failure_in_isolation(path, memory_is_limited) == "");
}

TEST_CASE("isolated reader: a stricter limit stays, and this process keeps its own") {
  const ScratchFolder scratch;
  const std::string path = scratch.write("a", "text");
  const rlim_t before = limit_of(RLIMIT_CPU);
  const auto with_a_stricter_limit = [&] {
    struct rlimit strict = {};
    getrlimit(RLIMIT_CPU, &strict);
    strict.rlim_cur = std::min<rlim_t>(strict.rlim_cur, 7);
    if (setrlimit(RLIMIT_CPU, &strict) != 0) return false;
    return failure_in_isolation(path, [&] { return limit_of(RLIMIT_CPU) == strict.rlim_cur; }) ==
           "";
  };
  CHECK(failure_in_isolation(path, with_a_stricter_limit) == "");
  CHECK(limit_of(RLIMIT_CPU) == before);
}

TEST_CASE("isolated reader: where no process can be made the file is named") {
  const ScratchFolder scratch;
  const std::string path = scratch.write("a", "text");
  fs::permissions(scratch.file(""), fs::perms(0755));
  const auto where_none_can_be_made = [&] {
    const struct rlimit none = {0, 0};
    if (setrlimit(RLIMIT_NPROC, &none) != 0) return false;
    if (geteuid() == 0 && setuid(65534) != 0) return false;  // limits are not of root
    try {
      failure_in_isolation(path, [] { return true; });
    } catch (const std::runtime_error& error) {
      return error.what() == path + ": no process can be made to read it";
    }
    return false;
  };
  CHECK(failure_in_isolation(path, where_none_can_be_made) == "");
}

TEST_CASE("isolated reader: where the system keeps no end of a process it is lost") {
  const ScratchFolder scratch;
  const std::string path = scratch.write("a", "text");
  const auto before = std::signal(SIGCHLD, SIG_IGN);
  CHECK_THROWS_WITH(failure_in_isolation(path, [] { return true; }),
                    path + ": the process that read it is lost");
  std::signal(SIGCHLD, before);
}

TEST_CASE("isolated reader: a signal while it waits does not end the wait") {
  const ScratchFolder scratch;
  const std::string path = scratch.write("a", "text");
  struct sigaction interrupt = {}, before = {};
  interrupt.sa_handler = [](int) {};
  sigaction(SIGALRM, &interrupt, &before);
  const itimerval soon = {{0, 5000}, {0, 5000}}, never = {};
  setitimer(ITIMER_REAL, &soon, nullptr);
  const auto slowly = [] {
    usleep(40'000);
    return false;
  };
  std::string failure;
  CHECK_NOTHROW(failure = failure_in_isolation(path, slowly));
  setitimer(ITIMER_REAL, &never, nullptr);
  sigaction(SIGALRM, &before, nullptr);
  CHECK(failure == "it is damaged");
}

}  // namespace foldproof
