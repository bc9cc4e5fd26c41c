#include "verification/files/isolated_reader.h"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <system_error>

#include "reference/types.h"

namespace foldproof {

namespace {

constexpr std::uintmax_t usual_seconds = 20, bytes_per_second = 10'000'000;
constexpr std::uintmax_t usual_memory = std::uintmax_t(1) << 30;

void limit(decltype(RLIMIT_CPU) what, std::uintmax_t most) {
  rlimit now{};
  if (getrlimit(what, &now) != 0 || now.rlim_cur <= most) return;  // a stricter limit stays
  now.rlim_cur = most;
  setrlimit(what, &now);
}

/// Address space in use [bytes]; 0 where the system does not say.
std::uintmax_t memory_in_use() {
  std::uintmax_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * std::uintmax_t(sysconf(_SC_PAGESIZE));
}

[[noreturn]] void read_and_leave(std::uintmax_t size, const std::function<bool()>& read) {
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, usual_seconds + size / bytes_per_second);
  if (const std::uintmax_t used = memory_in_use(); used > 0)
    limit(RLIMIT_AS, used + usual_memory + 2 * size);
  bool is_good = false;
  try {
    is_good = read();
  } catch (...) {  // a false answer
  }
  _exit(is_good ? 0 : 1);
}

}  // namespace

std::string failure_in_isolation(const std::string& path, const std::function<bool()>& read) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) return "it is not there";
  if (!std::filesystem::is_regular_file(status))
    throw InputError(path + ": cannot be read; give a regular file");
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error(path + ": no process can be made to read it");
  if (child == 0) read_and_leave(error ? 0 : size, read);
  int end = 0;
  while (waitpid(child, &end, 0) < 0)
    if (errno != EINTR) throw std::runtime_error(path + ": the process that read it is lost");
  if (WIFEXITED(end)) return WEXITSTATUS(end) == 0 ? "" : "it is damaged";
  return "it is damaged: reading it ended with signal " + std::to_string(WTERMSIG(end));
}

}  // namespace foldproof
