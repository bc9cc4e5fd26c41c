#include "scripts/program/campaign/work.h"

#include <fmt/format.h>
#include <sys/poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <ctime>
#include <deque>
#include <fstream>
#include <set>

#include "scripts/program/campaign/run_job.h"
#include "scripts/program/progress.h"
#include "scripts/program/run_case.h"
#include "verification/files/level_set_folder.h"

namespace foldproof {

namespace {

using Clock = std::chrono::steady_clock;

constexpr int cannot_write = 4;    // exit code of a worker
constexpr int between_looks = 20;  // ms
constexpr std::chrono::seconds between_flushes(2);

// ---- a worker: it is told numbers of jobs, and answers with lines for the shard -----------------

double address_space() {
  std::ifstream file("/proc/self/statm");
  double pages = 0;
  file >> pages;
  return pages * double(sysconf(_SC_PAGESIZE));
}

void limit(__rlimit_resource resource, double most) {
  const struct rlimit both = {rlim_t(most), rlim_t(most)};
  setrlimit(resource, &both);
}

/// Lines of a job's units that were not said before, and of its result; an empty one ends them.
std::string lines_of(const BatchJob& job, const JobAnswer& answer, std::set<std::string>& said) {
  Units fresh;
  for (const auto& [name, unit] : answer.units)
    if (said.insert(name).second) fresh[name] = unit;
  return (fresh.empty() ? "" : units_line(fresh) + "\n") + result_line(job.key, answer.result) +
         "\n\n";
}

[[noreturn]] void be_worker(const BatchTerms& terms, const std::vector<BatchJob>& jobs,
                            const LevelSetProvider& level_sets, int channel) {
  std::signal(SIGINT, SIG_IGN);  // the parent notes what is interrupted, and ends this process
  std::signal(SIGTERM, SIG_IGN);
  limit(RLIMIT_AS, terms.limits.memory + address_space());
  limit(RLIMIT_CORE, 0);
  std::set<std::string> units;
  try {
    for (size_t i = 0; read(channel, &i, sizeof i) == sizeof i;) {
      const std::string lines = lines_of(jobs[i], run_job(terms, jobs[i], level_sets), units);
      for (size_t sent = 0; sent < lines.size();) {
        const ssize_t some = write(channel, lines.data() + sent, lines.size() - sent);
        if (some <= 0) _exit(1);  // the parent is gone
        sent += size_t(some);
      }
    }
    _exit(0);
  } catch (const JobDied&) {
    _exit(1);
  } catch (const std::exception& error) {
    log_line(std::string("campaign: ") + error.what());
    _exit(cannot_write);
  }
}

// ---- the parent ---------------------------------------------------------------------------------

struct Worker {
  pid_t process = 0;  // 0: none
  int channel = -1;
  const BatchJob* job = nullptr;  // that it runs
  double start = 0;               // of the processor, when the job began [s]
  Clock::time_point clock_start;
  std::string answer;  // as far as it was heard
};

/// Of all threads of a process [s].
double processor_seconds_of(pid_t process) {
  clockid_t clock = 0;
  timespec spent{};
  if (clock_getcpuclockid(process, &clock) == 0) clock_gettime(clock, &spent);
  return double(spent.tv_sec) + 1e-9 * double(spent.tv_nsec);
}

class Crew {
 public:
  Crew(const BatchTerms& terms, std::vector<BatchJob> jobs, const WorkSettings& settings,
       const std::string& shard)
      : terms_(terms),
        jobs_(std::move(jobs)),
        level_sets_(memoizing_provider(provider_for(settings.cache, 1))),
        shard_(shard),
        workers_(std::min(size_t(std::max(1, settings.processes)), jobs_.size())) {
    for (size_t i = 0; i < jobs_.size(); ++i) waiting_.push_back(i);
  }
  ~Crew() {
    for (Worker& worker : workers_) end(worker);
  }

  void work(const std::function<void(size_t)>& show) {
    while (!waiting_.empty() || std::ranges::any_of(workers_, &Worker::job)) {
      for (Worker& worker : workers_)
        if (!worker.job && !waiting_.empty()) give_job(worker);
      listen();
      for (Worker& worker : workers_)
        if (worker.job) end_at_limit(worker);
      try {
        show(ended_);
      } catch (...) {
        for (const Worker& worker : workers_)
          if (worker.job) shard_.append(interruption_line(worker.job->key));
        throw;
      }
      if (ended_ > on_disk_ && Clock::now() - flushed_ > between_flushes) flush();
    }
    flush();
  }

 private:
  void flush() {
    shard_.flush_to_disk();
    on_disk_ = ended_;
    flushed_ = Clock::now();
  }

  void start(Worker& worker) {
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
      throw std::runtime_error("no channel can be made to a process that runs jobs");
    std::fflush(nullptr);
    const pid_t parent = getpid();
    worker = {fork(), ends[0], nullptr, 0, {}, ""};
    if (worker.process == 0) {
      prctl(PR_SET_PDEATHSIG, SIGKILL);  // not orphaned where the parent is killed
      if (getppid() != parent) _exit(1);
      be_worker(terms_, jobs_, level_sets_, ends[1]);
    }
    close(ends[1]);
    if (worker.process < 0) throw std::runtime_error("no process can be made to run jobs");
  }

  void give_job(Worker& worker) {
    if (worker.process == 0) start(worker);
    const size_t i = waiting_.front();
    waiting_.pop_front();
    worker.job = &jobs_[i];
    worker.start = processor_seconds_of(worker.process);
    worker.clock_start = Clock::now();
    shard_.append(start_line(worker.job->key, worker.job->label));
    send(worker.channel, &i, sizeof i, MSG_NOSIGNAL);  // one that is dead is noticed by listen()
  }

  void listen() {
    std::vector<pollfd> channels;
    for (const Worker& worker : workers_)
      channels.push_back({worker.job ? worker.channel : -1, POLLIN, 0});
    if (poll(channels.data(), channels.size(), between_looks) <= 0) return;
    for (size_t k = 0; k < workers_.size(); ++k)
      if (channels[k].revents != 0) hear(workers_[k]);
  }

  void hear(Worker& worker) {
    char piece[65536];
    const ssize_t count = recv(worker.channel, piece, sizeof piece, MSG_DONTWAIT);
    if (count == 0) return note_death(worker);
    if (count > 0) worker.answer.append(piece, size_t(count));
    if (!worker.answer.ends_with("\n\n")) return;
    shard_.append(worker.answer.substr(0, worker.answer.size() - 2));
    worker.answer.clear();
    worker.job = nullptr;
    ++ended_;
  }

  void note_death(Worker& worker) {
    BatchJob& job = jobs_[size_t(worker.job - jobs_.data())];
    const int status = end(worker);
    if (WIFEXITED(status) && WEXITSTATUS(status) == cannot_write)
      throw std::runtime_error(shard_.path() + ": results cannot be written; the batch stops");
    if (++job.starts < most_starts)
      waiting_.push_back(size_t(&job - jobs_.data()));
    else
      log_line(fmt::format("crashed after {} starts: {}", job.starts, job.label));
  }

  void end_at_limit(Worker& worker) {
    const double most = terms_.limits.seconds;
    const std::chrono::duration<double> clock = Clock::now() - worker.clock_start;
    if (processor_seconds_of(worker.process) - worker.start < most &&
        clock.count() < 10 * most + 10)
      return;
    JobResult result;
    result.end = JobEnd::timed_out;
    result.reason = fmt::format("took more than {:g} s", most);
    result.seconds = most;
    sign(result);
    shard_.append(result_line(worker.job->key, result));
    end(worker);
    ++ended_;
  }

  /// Returns its status, as of waitpid.
  static int end(Worker& worker) {
    int status = 0;
    if (worker.process > 0) {
      kill(worker.process, SIGKILL);
      waitpid(worker.process, &status, 0);
      close(worker.channel);
    }
    worker = {};
    return status;
  }

  const BatchTerms& terms_;
  std::vector<BatchJob> jobs_;
  std::deque<size_t> waiting_;
  LevelSetProvider level_sets_;
  ShardFile shard_;
  std::vector<Worker> workers_;
  size_t ended_ = 0, on_disk_ = 0;  // results
  Clock::time_point flushed_ = Clock::now();
};

}  // namespace

void work_through(const BatchTerms& terms, std::vector<BatchJob> jobs, const WorkSettings& settings,
                  const std::string& shard, const std::function<void(size_t)>& show) {
  std::erase_if(jobs, [](const BatchJob& job) { return job.starts >= most_starts; });
  std::ranges::stable_sort(jobs, {}, &BatchJob::starts);
  Crew(terms, std::move(jobs), settings, shard).work(show);
}

std::vector<BatchJob> missing_in(const std::vector<std::string>& shards,
                                 std::vector<BatchJob> jobs) {
  JobIndex known(shards);
  std::erase_if(jobs, [&](const BatchJob& job) { return known.find(job.key).has_value(); });
  const std::map<std::string, int> starts = known.open_starts();
  for (BatchJob& job : jobs)
    if (const auto open = starts.find(job.key); open != starts.end()) job.starts += open->second;
  return jobs;
}

}  // namespace foldproof
