// A program of its own in a process group of its own, with limits, and two channels to it.
#pragma once

#include <chrono>
#include <stdexcept>
#include <string>
#include <string_view>
#include <sys/types.h>
#include <vector>

#include "verification/subjects/pipe/processor_time.h"

namespace foldproof {

/// Resources that a solver may use before it is ended.
struct ProcessLimits {
  double seconds = 60;                         // clock time without a word, per call [s]
  std::chrono::steady_clock::time_point end =  // of all calls
      std::chrono::steady_clock::time_point::max();
  long processor_seconds = 3600;     // of the whole life [s]
  long memory_bytes = 4L << 30;      // private writable memory (RLIMIT_DATA)
  long bytes_per_file = 256L << 20;  // any file that it writes (RLIMIT_FSIZE)
};

/// A failure of a solver; the text says what happened, during which call, and the last words of the
/// solver. `cause` is one of
///   start                the shell found no such program, or cannot run it
///   crash, exit, hang    the process ended by a signal, ended by itself, or did not answer in time
///   truncated, oversized an answer that is shorter or longer than it says
///   header               no JSON object, a wrong id, a wrong type or version
///   shape, nan           arrays of other shapes or types than asked for; numbers that are not
///                        finite
///   error                the solver said that it failed
struct SolverFailure : std::runtime_error {
  std::string cause;
  std::string kind;  // what happened, without where: alike in failures that are the same
  SolverFailure(std::string cause_, const std::string& text, std::string kind_ = "")
      : std::runtime_error(text),
        cause(std::move(cause_)),
        kind(kind_.empty() ? text : std::move(kind_)) {}

  std::string in_one_line() const;
};

/// Thrown past a deadline.
struct TimedOut {
  size_t bytes;  // of the answer, that were read until then
};

/// The solver will not be asked again, since the end of its limits has come. It is not at fault.
struct TimeIsUp : std::runtime_error {
  TimeIsUp() : std::runtime_error("the time is up") {}
};

/// Runs `sh -c COMMAND` in a new process group. The child reads from the descriptor FOLDPROOF_IN
/// and writes to FOLDPROOF_OUT; its standard input is empty, its standard output and error are kept
/// as last words. FOLDPROOF_FOLDER and TMPDIR name a folder of its own. The destructor kills the
/// group and removes the folder.
class ChildProcess {
 public:
  using Deadline = std::chrono::steady_clock::time_point;

  /// Throws std::runtime_error if the system gives no process, channel or folder.
  ChildProcess(const std::string& command, const ProcessLimits& limits);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  // These throw SolverFailure: "crash", "exit", "start" if the child ends, and TimedOut.
  void write(std::string_view bytes, Deadline deadline);
  void read(char* to, size_t bytes, Deadline deadline);

  /// Up to and without the next newline. Throws "header" for one longer than `longest`.
  std::string read_line(size_t longest, Deadline deadline);

  /// Whether bytes wait to be read.
  bool has_unread_bytes();

  /// The end of what the child printed: at most ten lines, none of them empty.
  std::vector<std::string> last_words();

  /// Of the child and its own children.
  ProcessorTime processor_time() const;

  /// Bytes of an answer read so far; a child that ends in the middle left it truncated.
  void begin_answer() { read_of_answer_ = 0; }

 private:
  void wait_for(int descriptor, short events, Deadline deadline);
  void keep_words();
  bool has_ended() const;
  [[noreturn]] void report_end();
  size_t receive(char* to, size_t bytes, Deadline deadline);
  void end();

  pid_t process_ = -1;
  int channel_in_ = -1, channel_out_ = -1, words_ = -1;  // our ends
  std::string folder_, kept_words_, buffer_;
  size_t read_of_answer_ = 0;
};

}  // namespace foldproof
