#include "verification/subjects/pipe/processor_time.h"

#include <unistd.h>

#include <charconv>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

namespace foldproof {

namespace {

/// Of one process [s]; 0 if it has ended meanwhile.
double computing_seconds_of(pid_t process) {
  clockid_t clock;
  timespec time;
  if (clock_getcpuclockid(process, &clock) != 0 || clock_gettime(clock, &time) != 0) return 0;
  return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
}

/// The second number of its schedstat, in nanoseconds.
double waiting_seconds_of(const std::filesystem::path& process) {
  std::ifstream file(process / "schedstat");
  double computing = 0, waiting = 0;
  return file >> computing >> waiting ? 1e-9 * waiting : 0;
}

}  // namespace

ProcessorTime processor_time_of_group(pid_t group) {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  std::error_code unreadable;
  ProcessorTime sum{0, 0};
  bool is_known = false;
  for (const auto& entry : std::filesystem::directory_iterator("/proc", unreadable)) {
    const std::string name = entry.path().filename();
    pid_t process = 0;
    const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), process);
    const bool is_number = error == std::errc() && end == name.data() + name.size();
    if (!is_number || getpgid(process) != group) continue;
    sum.computing += computing_seconds_of(process);
    sum.waiting += waiting_seconds_of(entry.path());
    is_known = true;
  }
  return is_known ? sum : ProcessorTime{unknown, unknown};
}

}  // namespace foldproof
