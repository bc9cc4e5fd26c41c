#include "scripts/program/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace foldproof {

namespace {

constexpr double seconds_between_bars = 0.1, seconds_between_lines = 10;

constexpr double least_part = 0.01;  // that shows a pace

/// `seconds` were taken by `part`, and `left` is to come.
std::string time_left(double seconds, double part, double left) {
  if (!(part > least_part)) return "";
  const double seconds_left = std::max(0.0, seconds * left / part);
  return seconds_left < 90 ? fmt::format(", {:.0f} s left at this pace", seconds_left)
                           : fmt::format(", {:.0f} min left at this pace", seconds_left / 60);
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

void ProgressLine::start_stretch(double fraction) {
  stretch_start_ = seconds();
  stretch_part_ = fraction;
}

void ProgressLine::show(double fraction) {
  const double now = seconds();
  const double wait = on_terminal_ ? seconds_between_bars : seconds_between_lines;
  if (now - last_shown_ < wait) return;
  last_shown_ = now;
  const double done = std::clamp(fraction, 0.0, 1.0);
  const std::string left = time_left(now - stretch_start_, done - stretch_part_, 1 - done);
  if (on_terminal_) {
    const int width = 24, full = int(std::lround(done * width));
    fmt::print(stderr, "\r\033[K{} [{}{}] {:.0f} %{}", label_, std::string(size_t(full), '#'),
               std::string(size_t(width - full), ' '), 100 * done, left);
  } else {
    fmt::print(stderr, "{}: {:.0f} %{}\n", label_, 100 * done, left);
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
