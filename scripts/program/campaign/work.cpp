#include "scripts/program/campaign/work.h"

#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <new>

#include "scripts/program/campaign/run_job.h"
#include "scripts/program/interruption.h"
#include "scripts/program/progress.h"
#include "scripts/program/run_case.h"
#include "verification/files/level_set_folder.h"

namespace foldproof {

namespace {

using Clock = std::chrono::steady_clock;

constexpr int most_processes = 1024;
constexpr int ended_by_limit = 3, cannot_write = 4, job_died = 5;  // exit codes of a process
constexpr std::chrono::seconds between_flushes(2), between_marks(5), patience(10);

/// Shared by the processes of a slice.
struct Board {
  std::atomic<long> next = 0, ended = 0;
  std::array<std::atomic<long>, most_processes> current;  // job of each process; -1: none
};

/// A board in memory that a fork shares.
class SharedBoard {
 public:
  SharedBoard() {
    void* memory =
        mmap(nullptr, sizeof(Board), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) throw std::runtime_error("no memory to share between processes");
    board_ = new (memory) Board;
    for (auto& job : board_->current) job = -1;
  }
  ~SharedBoard() { munmap(board_, sizeof(Board)); }
  SharedBoard(const SharedBoard&) = delete;
  SharedBoard& operator=(const SharedBoard&) = delete;
  Board* operator->() const { return board_; }

 private:
  Board* board_;
};

// ---- one
// process ---------------------------------------------------------------------------------

/// What the handler of a time limit writes: prepared before the job, as it may not allocate.
struct LimitNotice {
  int file = -1;
  const char* text = nullptr;
  size_t size = 0;
} limit_notice;

void end_at_limit(int) {
  const ssize_t written = write(limit_notice.file, limit_notice.text, limit_notice.size);
  _exit(written == ssize_t(limit_notice.size) ? ended_by_limit : cannot_write);
}

void set_timer(int which, double seconds) {
  struct itimerval timer = {};
  timer.it_value.tv_sec = long(seconds);
  timer.it_value.tv_usec = long(1e6 * (seconds - double(long(seconds))));
  setitimer(which, &timer, nullptr);
}

/// While it lives, a job that takes too long ends the process with a result of its own: a hang
/// cannot be ended in another way.
class TimeLimit {
 public:
  TimeLimit(const std::string& key, double seconds, const JobShard& shard) {
    JobResult result;
    result.end = JobEnd::timed_out;
    result.reason = fmt::format("took more than {:g} s", seconds);
    result.seconds = seconds;
    sign(result);
    text_ = JobShard::line_of(key, result);
    limit_notice = {shard.descriptor(), text_.data(), text_.size()};
    for (const int signal : {SIGPROF, SIGALRM}) std::signal(signal, end_at_limit);
    set_timer(ITIMER_PROF, seconds);
    set_timer(ITIMER_REAL, 10 * seconds + 10);
  }
  ~TimeLimit() {
    for (const int which : {ITIMER_PROF, ITIMER_REAL}) set_timer(which, 0);
  }
  TimeLimit(const TimeLimit&) = delete;
  TimeLimit& operator=(const TimeLimit&) = delete;

 private:
  std::string text_;
};

double address_space() {
  std::ifstream file("/proc/self/statm");
  double pages = 0;
  file >> pages;
  return pages * double(sysconf(_SC_PAGESIZE));
}

struct Worker {
  const Batch& batch;
  const std::vector<BatchJob>& jobs;
  Board& board;
  int slot;
  JobShard shard;
  LevelSetProvider level_sets;
  InterruptionWatch watch = {};
};

void run_one(Worker& w, const BatchJob& job) {
  w.shard.start(job.key, job.label);
  JobAnswer answer;
  try {
    const TimeLimit limit(job.key, w.batch.terms.limits.seconds, w.shard);
    answer = run_job(w.batch.terms, job, w.level_sets, [&](double) { w.watch.check(); });
  } catch (const Interrupted&) {
    w.shard.interrupt(job.key);
    throw;
  }
  w.shard.end(job.key, answer.result, answer.units);
}

/// Takes jobs until none is left. Returns the exit code.
int work(Worker& w) {
  auto flushed = Clock::now();
  try {
    for (;;) {
      w.watch.check();
      const long i = w.board.next++;
      if (i >= long(w.jobs.size())) break;
      w.board.current[size_t(w.slot)] = i;
      run_one(w, w.jobs[size_t(i)]);
      ++w.board.ended;
      w.board.current[size_t(w.slot)] = -1;
      if (Clock::now() - flushed < between_flushes) continue;
      w.shard.flush_to_disk();
      flushed = Clock::now();
    }
    w.shard.flush_to_disk();
    return 0;
  } catch (const Interrupted& interrupted) {
    return 128 + interrupted.signal;
  } catch (const JobDied&) {
    return job_died;
  } catch (const std::exception& error) {
    log_line(std::string("campaign: ") + error.what());
    return cannot_write;
  }
}

[[noreturn]] void be_worker(Worker& w, pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGTERM);  // not orphaned where the parent is killed
  if (getppid() != parent) _exit(1);
  const double most = w.batch.terms.limits.memory + address_space();
  const struct rlimit memory = {rlim_t(most), rlim_t(most)};
  setrlimit(RLIMIT_AS, &memory);
  const struct rlimit no_core = {0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
  _exit(work(w));
}

// ---- the
// parent ----------------------------------------------------------------------------------

/// The processes of a slice, and the jobs that they are to run.
class Crew {
 public:
  Crew(const Batch& batch, size_t slice, std::vector<BatchJob> jobs, const WorkSettings& settings)
      : batch_(batch), slice_(slice), settings_(settings), jobs_(std::move(jobs)) {
    level_sets_ = memoizing_provider(provider_for(settings.cache, 1));
  }
  ~Crew() { end_all(SIGKILL); }

  WorkDone work(const std::function<void(size_t)>& show) {
    while (!jobs_.empty()) {
      run_round(show);
      jobs_ = std::move(again_);
      again_.clear();
    }
    return done_;
  }

 private:
  void run_round(const std::function<void(size_t)>& show) {
    std::ranges::stable_sort(jobs_, {}, &BatchJob::starts);
    board_->next = 0;
    const size_t processes =
        std::min({size_t(settings_.processes), jobs_.size(), size_t(most_processes)});
    crew_.assign(processes, 0);
    for (size_t slot = 0; slot < processes; ++slot) start(slot);
    while (std::ranges::any_of(crew_, [](pid_t process) { return process > 0; })) {
      reap();
      try {
        show(size_t(board_->ended));
      } catch (...) {
        end_all(SIGTERM);
        throw;
      }
      if (Clock::now() - marked_ > between_marks) mark_alive(batch_), marked_ = Clock::now();
      usleep(5000);
    }
    done_.ended = size_t(board_->ended);
  }

  void start(size_t slot) {
    const std::string folder =
        settings_.shards.empty() ? shard_folder(batch_, slice_) : settings_.shards;
    done_.shards.push_back(folder + "/" + new_shard_of_slice(slice_));
    const std::string& shard = done_.shards.back();
    std::fflush(nullptr);
    const pid_t parent = getpid(), process = fork();
    if (process < 0) throw std::runtime_error("no process can be made to run jobs");
    if (process == 0) {
      Worker worker{batch_, jobs_, *board_.operator->(), int(slot), JobShard(shard), level_sets_};
      be_worker(worker, parent);
    }
    crew_[slot] = process;
  }

  void reap() {
    for (size_t slot = 0; slot < crew_.size(); ++slot) {
      int status = 0;
      if (crew_[slot] <= 0 || waitpid(crew_[slot], &status, WNOHANG) != crew_[slot]) continue;
      crew_[slot] = 0;
      const long job = board_->current[slot].exchange(-1);
      if (WIFEXITED(status) && WEXITSTATUS(status) == cannot_write)
        throw std::runtime_error(batch_.folder + ": results cannot be written; the batch stops");
      if (job < 0) continue;  // it came to its end, or was interrupted between two jobs
      const bool has_result = WIFEXITED(status) && WEXITSTATUS(status) == ended_by_limit;
      if (has_result)
        ++board_->ended;
      else
        note_death(size_t(job));
      if (board_->next < long(jobs_.size())) start(slot);
    }
  }

  void note_death(size_t job) {
    BatchJob& dead = jobs_[job];
    if (++dead.starts < most_starts) {
      again_.push_back(dead);
      return;
    }
    ++done_.crashed;
    log_line(fmt::format("crashed after {} starts: {}", dead.starts, dead.label));
  }

  /// SIGTERM lets them note what they interrupt; who does not end within a while is killed.
  void end_all(int signal) {
    const auto until = Clock::now() + patience;
    for (const pid_t process : crew_)
      if (process > 0) kill(process, signal);
    for (pid_t& process : crew_)
      while (process > 0) {
        if (Clock::now() > until) kill(process, SIGKILL);
        if (waitpid(process, nullptr, WNOHANG) != 0) process = 0;
        usleep(2000);
      }
  }

  const Batch& batch_;
  size_t slice_;
  const WorkSettings& settings_;
  std::vector<BatchJob> jobs_, again_;
  LevelSetProvider level_sets_;
  SharedBoard board_;
  std::vector<pid_t> crew_;  // by slot; 0: none
  WorkDone done_;
  Clock::time_point marked_ = Clock::now();
};

}  // namespace

WorkDone work_through(const Batch& batch, size_t slice, std::vector<BatchJob> jobs,
                      const WorkSettings& settings, const std::function<void(size_t)>& show) {
  std::erase_if(jobs, [](const BatchJob& job) { return job.starts >= most_starts; });
  return Crew(batch, slice, std::move(jobs), settings).work(show);
}

std::vector<BatchJob> missing_in(const std::vector<std::string>& shards,
                                 std::vector<BatchJob> jobs) {
  const ShardState known = read_shard_state(shards);
  std::erase_if(jobs, [&](const BatchJob& job) { return known.results.contains(job.key); });
  for (BatchJob& job : jobs)
    if (const auto starts = known.open_starts.find(job.key); starts != known.open_starts.end())
      job.starts += starts->second;
  return jobs;
}

}  // namespace foldproof
