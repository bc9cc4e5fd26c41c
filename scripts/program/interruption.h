// Ctrl-C and SIGTERM: a command says what is kept, and what to type to go on.
#pragma once

#include <string>

namespace foldproof {

/// Thrown by a long command when it is interrupted; not a std::exception, so that nothing that
/// reports errors takes it for one.
struct Interrupted {
  int signal;
};

/// For a run that is stopped between two steps, so that it can say how far it came.
/// While it lives, the first SIGINT or SIGTERM is only remembered. The second ends the
/// program as always.
class InterruptionWatch {
 public:
  InterruptionWatch();
  ~InterruptionWatch();
  InterruptionWatch(const InterruptionWatch&) = delete;
  InterruptionWatch& operator=(const InterruptionWatch&) = delete;

  /// Throws Interrupted if there was a signal.
  void check() const;
};

/// For commands that keep each result as soon as it is there: nothing is left to save.
/// While it lives, SIGINT or SIGTERM writes one line on standard error and ends the program by the
/// signal at once.
class InterruptionNotice {
 public:
  /// command: what to type to go on; "" if nothing is kept.
  InterruptionNotice(const std::string& kept, const std::string& command);
  ~InterruptionNotice();
  InterruptionNotice(const InterruptionNotice&) = delete;
  InterruptionNotice& operator=(const InterruptionNotice&) = delete;

 private:
  std::string text_;
};

/// Ends the program by the signal, so that a shell sees 130 (Ctrl-C) or 143 (SIGTERM) and
/// stops its loop.
[[noreturn]] void end_by(const Interrupted& interrupted);

}  // namespace foldproof
