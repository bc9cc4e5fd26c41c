#include "scripts/program/interruption.h"

#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>

namespace foldproof {

namespace {

volatile std::sig_atomic_t signal_seen = 0;

void remember(int signal) { signal_seen = signal; }

/// The line of the notice that lives. A child of this process shares the handler until it starts
/// another program, and must not say the line again.
struct {
  pid_t owner = 0;
  const char* text = nullptr;
  size_t size = 0;
} notice;

void say_and_end(int signal) {
  if (getpid() == notice.owner) {
    [[maybe_unused]] const ssize_t unheeded = write(STDERR_FILENO, notice.text, notice.size);
  }
  std::raise(signal);  // blocked here; the default action follows when this returns
}

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

InterruptionNotice::InterruptionNotice(const std::string& kept, const std::string& command)
    : text_("interrupted; " + kept + (command.empty() ? "" : "; go on with: " + command) + "\n") {
  if (isatty(STDERR_FILENO)) text_ = "\r\033[K" + text_;  // wipes a bar of progress
  notice = {getpid(), text_.data(), text_.size()};
  for (const int signal : {SIGINT, SIGTERM}) handle(signal, say_and_end, SA_RESETHAND | SA_RESTART);
}

InterruptionNotice::~InterruptionNotice() {
  for (const int signal : {SIGINT, SIGTERM}) handle(signal, SIG_DFL, 0);
}

void end_by(const Interrupted& interrupted) {
  std::fflush(nullptr);
  handle(interrupted.signal, SIG_DFL, 0);
  std::raise(interrupted.signal);
  std::_Exit(128 + interrupted.signal);  // the signal is blocked
}

}  // namespace foldproof
