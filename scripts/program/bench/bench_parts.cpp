#include "scripts/program/bench/bench_parts.h"

#include <malloc.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <limits>

namespace foldproof {

double seconds_of(const std::function<void()>& run) {
  const auto start = std::chrono::steady_clock::now();
  run();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double least_seconds(const std::function<void()>& run) {
  constexpr double long_enough = 1;  // s; a longer measurement need not be repeated
  double least = seconds_of(run), total = least;
  for (int k = 1; total < long_enough && (k < 3 || total < 0.2); ++k) {
    const double seconds = seconds_of(run);
    least = std::min(least, seconds);
    total += seconds;
  }
  return least;
}

double resident_megabytes(const std::string& what) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with(what + ":")) return std::stod(line.substr(what.size() + 1)) / 1024;
  return std::numeric_limits<double>::quiet_NaN();
}

void forget_peak() {
  malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << "5";
}

Record rate(const std::string& name, const std::string& claim, double measured,
            const Target& target) {
  const Verdict verdict{measured, target.value, 0, target.unit, target.why};
  return {
      "bench." + name, "bench",       "", claim, "", {verdict, {}, "one thread, least of repeats"},
      std::nullopt,    target.better, 0,  {}};
}

double growth_exponent(const std::vector<double>& sizes, const std::vector<double>& seconds) {
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  const double n = double(sizes.size());
  for (size_t k = 0; k < sizes.size(); ++k) {
    const double a = std::log(sizes[k]), b = std::log(seconds[k]);
    sx += a, sy += b, sxx += a * a, sxy += a * b;
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

}  // namespace foldproof
