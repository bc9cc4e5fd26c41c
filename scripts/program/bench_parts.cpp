#include "scripts/program/bench_parts.h"

#include <algorithm>
#include <chrono>

namespace foldproof {

double seconds_of(const std::function<void()>& run) {
  const auto start = std::chrono::steady_clock::now();
  run();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double least_seconds(const std::function<void()>& run) {
  constexpr double long_enough = 1;  // s, of which a repeat is not worth its time
  double least = seconds_of(run), total = least;
  for (int k = 1; total < long_enough && (k < 3 || total < 0.2); ++k) {
    const double seconds = seconds_of(run);
    least = std::min(least, seconds);
    total += seconds;
  }
  return least;
}

Record rate(const std::string& name, const std::string& claim, double measured, const Target& target) {
  const Verdict verdict{measured, target.value, 0, target.unit, target.why};
  return {"bench." + name, "bench",       "", claim, "", {verdict, {}, "one thread, least of repeats"},
          "measured",      target.better, 0,  {}};
}

}  // namespace foldproof
