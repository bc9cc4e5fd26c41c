#include "scripts/program/jobs.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <iterator>
#include <mutex>
#include <numeric>
#include <random>
#include <thread>
#include <utility>

#include "scripts/program/kept_results.h"
#include "scripts/program/progress.h"

namespace foldproof {

namespace {

void log_unless_it_holds(const Record& record) {
  if (record.outcome == Outcome::holds) return;
  const Verdict& v = record.finding.verdict;
  log_line(fmt::format("  {}: {} (measured {:.4g}, bound {:.4g} {}) {}", outcome_text(record),
                       record.name, v.measured, v.bound, v.unit, record.finding.note));
}

template <class T>
void append(std::vector<T>& from, std::vector<T>& to) {
  std::move(from.begin(), from.end(), std::back_inserter(to));
}

/// Numbers of the jobs as they are to be taken, the first last.
std::vector<size_t> order_of_jobs(const std::vector<Job>& jobs, unsigned order) {
  std::vector<size_t> numbers(jobs.size());
  std::iota(numbers.begin(), numbers.end(), size_t(0));
  std::ranges::stable_sort(numbers, {},
                           [&](size_t i) { return std::pair(-jobs[i].group, jobs[i].length); });
  std::mt19937 random(order);
  for (size_t k = numbers.size(); order > 0 && k > 1; --k)
    std::swap(numbers[k - 1], numbers[random() % k]);
  return numbers;
}

/// The jobs that wait, and what came of those that are done. Shared by all threads.
class Queue {
 public:
  Queue(const std::vector<Job>& jobs, const ProgressSpan& span, unsigned order)
      : jobs_(jobs),
        waiting_(order_of_jobs(jobs, order)),
        done_(jobs.size()),
        parts_(jobs.size()),
        span_(span) {}

  /// Takes jobs until none is left.
  void work() {
    for (size_t i = 0; take(i);) {
      try {
        parts_[i] = jobs_[i].run([&, i](double part) { show(i, part); });
      } catch (const std::exception& error) {
        parts_[i] = {};
        parts_[i].records = {unfinished_record(
            jobs_[i].name, Outcome::fails, std::string("stopped by an error: ") + error.what())};
      }
      show(i, 1);
      const std::lock_guard held(mutex_);
      for (const Record& record : parts_[i].records) log_unless_it_holds(record);
    }
  }

  void gather(RunRecord& run) {
    for (RunRecord& part : parts_) {
      append(part.records, run.records);
      append(part.studies, run.studies);
      append(part.cases, run.cases);
    }
  }

 private:
  bool take(size_t& i) {
    const std::lock_guard held(mutex_);
    if (waiting_.empty()) return false;
    i = waiting_.back();
    waiting_.pop_back();
    return true;
  }

  void show(size_t i, double part) {
    const std::lock_guard held(mutex_);
    total_ += jobs_[i].length * (part - done_[i]);
    done_[i] = part;
    span_.line.show((span_.before + total_) / span_.whole);
  }

  const std::vector<Job>& jobs_;
  std::mutex mutex_;
  std::vector<size_t> waiting_;
  std::vector<double> done_;  // the part of each job
  std::vector<RunRecord> parts_;
  double total_ = 0;  // of the lengths, done
  ProgressSpan span_;
};

}  // namespace

Record unfinished_record(const std::string& name, std::optional<Outcome> outcome,
                         const std::string& note) {
  Record record;
  record.name = name;
  record.kind = "check";
  record.claim = "It runs to its end.";
  record.finding = {{nan, nan, nan, "1", "without an end there is nothing to judge"}, {}, note};
  record.outcome = outcome;
  return record;
}

void run_jobs(const std::vector<Job>& jobs, const std::string& label, const JobSettings& settings,
              RunRecord& run) {
  ProgressLine line(label);
  double whole = 0;
  for (const Job& job : jobs) whole += job.length;
  run_jobs(jobs, {line, 0, whole}, settings, run);
}

int threads_of(const JobSettings& running) {
  return int(running.threads > 0 ? running.threads
                                 : std::max(1u, std::thread::hardware_concurrency()));
}

void run_jobs(const std::vector<Job>& jobs, const ProgressSpan& span, const JobSettings& settings,
              RunRecord& run) {
  KeptResults kept(settings, run);
  const std::vector<Job> all = kept.wrapped(jobs);
  Queue queue(all, span, settings.order);
  {
    const auto threads = std::min(size_t(threads_of(settings)), all.size());
    std::vector<std::jthread> others;
    for (size_t k = 1; k < threads; ++k) others.emplace_back([&] { queue.work(); });
    queue.work();
  }
  queue.gather(run);
  kept.name_origins(run);
}

}  // namespace foldproof
