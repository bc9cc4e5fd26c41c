#include "scripts/program/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace foldproof {

namespace {

constexpr double seconds_between_bars = 0.1, seconds_between_lines = 10;

std::string time_left(double seconds, double fraction) {
  if (!(fraction > 0.01)) return "";
  const double left = std::max(0.0, seconds * (1 / fraction - 1));
  return left < 90 ? fmt::format("{:.0f} s left", left) : fmt::format("{:.0f} min left", left / 60);
}

}  // namespace

ProgressLine::ProgressLine(std::string label)
    : label_(std::move(label)), on_terminal_(isatty(STDERR_FILENO)) {
  show(0);
}

ProgressLine::~ProgressLine() {
  if (on_terminal_) std::fputs("\r\033[K", stderr);
}

double ProgressLine::seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

void ProgressLine::show(double fraction) {
  const double now = seconds();
  const double wait = on_terminal_ ? seconds_between_bars : seconds_between_lines;
  if (now - last_shown_ < wait) return;
  last_shown_ = now;
  const double done = std::clamp(fraction, 0.0, 1.0);
  if (on_terminal_) {
    const int width = 24, full = int(std::lround(done * width));
    fmt::print(stderr, "\r\033[K{} [{}{}] {:.0f} % {}", label_, std::string(size_t(full), '#'),
               std::string(size_t(width - full), ' '), 100 * done, time_left(now, done));
  } else {
    fmt::print(stderr, "{}: {:.0f} %, {}\n", label_, 100 * done, time_left(now, done));
  }
  std::fflush(stderr);
}

void show_line(const std::string& line) {
  if (!isatty(STDERR_FILENO)) return log_line(line);
  fmt::print(stderr, "\r\033[K{}", line);
  std::fflush(stderr);
}

void end_line() {
  if (isatty(STDERR_FILENO)) std::fputs("\r\033[K", stderr);
}

void log_line(const std::string& line) {
  if (isatty(STDERR_FILENO)) std::fputs("\r\033[K", stderr);
  fmt::print(stderr, "{}\n", line);
}

}  // namespace foldproof
