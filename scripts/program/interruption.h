// Ctrl-C and SIGTERM, met between two steps rather than within one.
#pragma once

namespace foldproof {

/// Thrown by a long command when it is interrupted; not a std::exception, so that nothing that
/// reports errors takes it for one.
struct Interrupted {
  int signal;
};

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

/// Ends the program by the signal, so that a shell sees 130 (Ctrl-C) or 143 (SIGTERM) and
/// stops its loop.
[[noreturn]] void end_by(const Interrupted& interrupted);

}  // namespace foldproof
