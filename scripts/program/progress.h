// Progress on standard error: a bar with the time left on a terminal, a plain line now and
// then elsewhere.
#pragma once

#include <chrono>
#include <string>

namespace foldproof {

class ProgressLine {
 public:
  explicit ProgressLine(std::string label);
  ~ProgressLine();  // wipes the bar

  /// fraction done, from 0 to 1.
  void show(double fraction);

  /// From here on, at this fraction, another forecast holds: the time left follows from
  /// the pace since.
  void start_stretch(double fraction);

  /// Since it was made [s].
  double seconds() const;

 private:
  std::string label_;
  bool on_terminal_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  double last_shown_ = 0;                        // s
  double stretch_start_ = 0, stretch_part_ = 0;  // s, 1
};

/// A line on standard error that takes the place of the one before it; elsewhere than on a terminal
/// one after the other.
void show_line(const std::string& line);

/// Wipes the line of show_line.
void end_line();

/// A plain line on standard error.
void log_line(const std::string& line);

}  // namespace foldproof
