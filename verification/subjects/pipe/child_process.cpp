#include "verification/subjects/pipe/child_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <thread>
#include <vector>

namespace foldproof {

namespace {

constexpr size_t kept_bytes = 4096;

[[noreturn]] void fail_of_system(const char* what) {
  throw std::runtime_error(fmt::format("cannot start a solver: {}: {}", what, strerror(errno)));
}

struct Ends {
  int ours, theirs;
};

/// Two connected ends; ours is not inherited. A socket, so that writing to a dead child is an
/// error and no signal.
Ends make_channel() {
  int pair[2];
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, pair) != 0) fail_of_system("socketpair");
  return {pair[0], pair[1]};
}

std::string make_own_folder() {
  std::string name = (std::filesystem::temp_directory_path() / "foldproof-solver-XXXXXX").string();
  if (!mkdtemp(name.data())) fail_of_system(name.c_str());
  return name;
}

void set_limit(decltype(RLIMIT_DATA) resource, long value) {
  const rlimit limit{rlim_t(value), rlim_t(value)};
  setrlimit(resource, &limit);
}

/// Our environment with the solver's own variables.
std::vector<std::string> environment_of(const std::string& folder, int in, int out) {
  std::vector<std::string> all{fmt::format("FOLDPROOF_IN={}", in),
                               fmt::format("FOLDPROOF_OUT={}", out), "FOLDPROOF_FOLDER=" + folder,
                               "TMPDIR=" + folder};
  for (char** entry = environ; *entry; ++entry)
    if (!std::string_view(*entry).starts_with("TMPDIR=") &&
        !std::string_view(*entry).starts_with("FOLDPROOF_"))
      all.emplace_back(*entry);
  return all;
}

std::vector<char*> pointers_to(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  for (std::string& text : texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

/// The inherited descriptors of a child.
struct ChildEnds {
  int in, out, words, nothing;
};

/// In the child: only calls that are safe after fork.
[[noreturn]] void become(char** arguments, char** environment, const ChildEnds& ends,
                         const ProcessLimits& limits) {
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  set_limit(RLIMIT_CORE, 0);
  set_limit(RLIMIT_CPU, limits.processor_seconds);
  set_limit(RLIMIT_DATA, limits.memory_bytes);
  set_limit(RLIMIT_FSIZE, limits.bytes_per_file);
  signal(SIGXFSZ, SIG_DFL);
  dup2(ends.nothing, 0);
  dup2(ends.words, 1);
  dup2(ends.words, 2);
  fcntl(ends.in, F_SETFD, 0);
  fcntl(ends.out, F_SETFD, 0);
  execve("/bin/sh", arguments, environment);
  _exit(127);
}

/// The lines that are not empty, other control characters as blanks.
std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines{""};
  for (const char c : text)
    if (c == '\n' || c == '\r')
      lines.emplace_back();
    else
      lines.back() += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
  for (std::string& line : lines) line.erase(line.find_last_not_of(' ') + 1);
  std::erase(lines, "");
  return lines;
}

/// How a process ended: cause and words. A shell reports the signal of its command as 128 + signal.
std::pair<std::string, std::string> cause_of(int status) {
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 0;
  const int signal = WIFSIGNALED(status)        ? WTERMSIG(status)
                     : code > 128 && code < 160 ? code - 128
                                                : 0;
  if (signal != 0)
    return {"crash", fmt::format("crashed with signal {} ({})", signal, strsignal(signal))};
  if (code == 127) return {"start", "exited with code 127: its command was not found"};
  if (code == 126) return {"start", "exited with code 126: its command cannot be run"};
  return {"exit", fmt::format("exited with code {}", code)};
}

}  // namespace

std::string SolverFailure::in_one_line() const {
  std::string line;
  for (const std::string& part : lines_of(what()))
    line += (line.empty() ? "" : " ") + part.substr(part.find_first_not_of(' '));
  return line;
}

ChildProcess::ChildProcess(const std::string& command, const ProcessLimits& limits)
    : folder_(make_own_folder()) {
  const Ends in = make_channel(), out = make_channel(), words = make_channel();
  channel_in_ = in.ours, channel_out_ = out.ours, words_ = words.ours;
  const int nothing = open("/dev/null", O_RDONLY | O_CLOEXEC);
  std::vector<std::string> arguments{"sh", "-c", command};
  std::vector<std::string> environment = environment_of(folder_, in.theirs, out.theirs);
  const std::vector<char*> argv = pointers_to(arguments), envp = pointers_to(environment);
  process_ = fork();
  if (process_ == 0)
    become(const_cast<char**>(argv.data()), const_cast<char**>(envp.data()),
           {in.theirs, out.theirs, words.theirs, nothing}, limits);
  for (const int end : {in.theirs, out.theirs, words.theirs, nothing}) close(end);
  if (process_ < 0) {
    end();
    fail_of_system("fork");
  }
  setpgid(process_, process_);  // in the child too: whichever comes first
}

ChildProcess::~ChildProcess() { end(); }

void ChildProcess::end() {
  if (process_ > 0) {
    kill(-process_, SIGKILL);
    waitpid(process_, nullptr, 0);
  }
  process_ = -1;
  for (int* descriptor : {&channel_in_, &channel_out_, &words_}) {
    if (*descriptor >= 0) close(*descriptor);
    *descriptor = -1;
  }
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

ProcessorTime ChildProcess::processor_time() const { return processor_time_of_group(process_); }

void ChildProcess::keep_words() {
  std::array<char, 4096> part;
  for (ssize_t got; (got = recv(words_, part.data(), part.size(), MSG_DONTWAIT)) > 0;) {
    kept_words_.append(part.data(), size_t(got));
    if (kept_words_.size() > kept_bytes) kept_words_.erase(0, kept_words_.size() - kept_bytes);
    if (size_t(got) < part.size()) return;  // a child that prints without end is heard in turns
  }
}

std::vector<std::string> ChildProcess::last_words() {
  keep_words();
  constexpr size_t longest = 2000, most_lines = 10;
  const size_t from = kept_words_.size() > longest ? kept_words_.size() - longest : 0;
  std::vector<std::string> lines = lines_of(kept_words_.substr(from));
  if (lines.size() > most_lines) lines.erase(lines.begin(), lines.end() - most_lines);
  return lines;
}

bool ChildProcess::has_ended() const {
  siginfo_t info{};
  return waitid(P_PID, id_t(process_), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
         info.si_pid == process_;
}

/// The channel is closed: waits up to 2 s for the status, then throws.
void ChildProcess::report_end() {
  int status = 0;
  pid_t ended = 0;
  for (int k = 0; k < 200 && (ended = waitpid(process_, &status, WNOHANG)) == 0; ++k)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  if (ended != process_) throw SolverFailure("exit", "closed its channel without ending");
  kill(-process_, SIGKILL);  // what it may have forked
  process_ = -1;
  const auto [cause, words] = cause_of(status);
  if (cause == "exit" && read_of_answer_ > 0)
    throw SolverFailure("truncated", fmt::format("{} in the middle of an answer, after {} bytes",
                                                 words, read_of_answer_));
  throw SolverFailure(cause, words);
}

void ChildProcess::wait_for(int descriptor, short events, Deadline deadline) {
  pollfd watched[2] = {{descriptor, events, 0}, {words_, POLLIN, 0}};
  int count = 2;
  while (true) {
    const auto left =
        std::chrono::ceil<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
    if (left.count() <= 0) throw TimedOut{read_of_answer_};
    constexpr long glance = 100;  // ms; a child's own children may keep its channels open
    const int ready = poll(watched, nfds_t(count), int(std::min(long(left.count()), glance)));
    if (ready < 0 && errno != EINTR) fail_of_system("poll");
    if (ready == 0 && has_ended()) report_end();
    if (ready <= 0) continue;
    if (count == 2 && watched[1].revents) {
      keep_words();
      if (!(watched[1].revents & POLLIN)) count = 1;  // it closed its standard output
    }
    if (watched[0].revents) return;
  }
}

void ChildProcess::write(std::string_view bytes, Deadline deadline) {
  while (!bytes.empty()) {
    wait_for(channel_in_, POLLOUT, deadline);
    const ssize_t sent = send(channel_in_, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent < 0 && errno != EAGAIN && errno != EINTR) report_end();
    if (sent > 0) bytes.remove_prefix(size_t(sent));
  }
}

size_t ChildProcess::receive(char* to, size_t bytes, Deadline deadline) {
  while (true) {
    wait_for(channel_out_, POLLIN, deadline);
    const ssize_t got = recv(channel_out_, to, bytes, MSG_DONTWAIT);
    if (got > 0) {
      read_of_answer_ += size_t(got);
      return size_t(got);
    }
    if (got == 0 || (errno != EAGAIN && errno != EINTR)) report_end();
  }
}

void ChildProcess::read(char* to, size_t bytes, Deadline deadline) {
  const size_t kept = std::min(bytes, buffer_.size());
  std::memcpy(to, buffer_.data(), kept);
  buffer_.erase(0, kept);
  for (size_t done = kept; done < bytes;) done += receive(to + done, bytes - done, deadline);
}

std::string ChildProcess::read_line(size_t longest, Deadline deadline) {
  std::array<char, 65536> part;
  size_t searched = 0;
  while (true) {
    const size_t end_of_line = buffer_.find('\n', searched);
    if (end_of_line != std::string::npos) {
      std::string line = buffer_.substr(0, end_of_line);
      buffer_.erase(0, end_of_line + 1);
      return line;
    }
    searched = buffer_.size();
    if (searched > longest)
      throw SolverFailure("header", fmt::format("sent a header longer than {} bytes", longest));
    buffer_.append(part.data(), receive(part.data(), part.size(), deadline));
  }
}

bool ChildProcess::has_unread_bytes() {
  char one;
  return !buffer_.empty() || recv(channel_out_, &one, 1, MSG_PEEK | MSG_DONTWAIT) > 0;
}

}  // namespace foldproof
