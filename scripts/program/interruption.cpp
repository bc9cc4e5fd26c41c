#include "scripts/program/interruption.h"

#include <csignal>
#include <cstdio>
#include <cstdlib>

namespace foldproof {

namespace {

volatile std::sig_atomic_t signal_seen = 0;

void remember(int signal) { signal_seen = signal; }

void handle(int signal, void (*handler)(int), int flags) {
  struct sigaction action = {};
  action.sa_handler = handler;
  action.sa_flags = flags;
  sigaction(signal, &action, nullptr);
}

}  // namespace

InterruptionWatch::InterruptionWatch() {
  signal_seen = 0;
  for (const int signal : {SIGINT, SIGTERM}) handle(signal, remember, SA_RESETHAND | SA_RESTART);
}

InterruptionWatch::~InterruptionWatch() {
  for (const int signal : {SIGINT, SIGTERM}) handle(signal, SIG_DFL, 0);
}

void InterruptionWatch::check() const {
  if (signal_seen != 0) throw Interrupted{signal_seen};
}

void end_by(const Interrupted& interrupted) {
  std::fflush(nullptr);
  handle(interrupted.signal, SIG_DFL, 0);
  std::raise(interrupted.signal);
  std::_Exit(128 + interrupted.signal);  // the signal is blocked
}

}  // namespace foldproof
