#include "reference/fast/loops.h"

#include <atomic>
#include <exception>
#include <thread>

namespace foldproof {

namespace {

// A thread that waits looks so often before it sleeps: some tens of microseconds, the time between
// two loops of a step. Where other programs need the core, it goes to them at once.
constexpr int looks_before_sleep = 100;

/// Waits until the value is no longer `old`; returns it.
int next_value(const std::atomic<int>& value, int old) {
  for (int k = 0; k < looks_before_sleep && value == old; ++k) std::this_thread::yield();
  value.wait(old);
  return value;
}

/// The calling thread and its helpers. Whoever is free takes the next part: where other programs
/// need the cores, the caller waits for nobody who has not begun. The last part comes first, so
/// that results that depend on the order differ from those of one thread even on one core.
class Team {
 public:
  explicit Team(int threads) : threads_(threads) {
    for (int k = 1; k < threads; ++k) others_.emplace_back([this] { work(); });
  }
  ~Team() {
    ends_ = true;
    start_round();
  }
  int threads() const { return threads_; }

  /// As many parts as threads; act must not throw.
  void run(const std::function<void(int)>& act) {
    act_ = &act;
    unfinished_ = threads_;
    next_part_ = threads_;
    start_round();
    take_parts();
    for (int left = unfinished_; left > 0;) left = next_value(unfinished_, left);
  }

 private:
  void start_round() {
    ++round_;
    round_.notify_all();
  }
  void take_parts() {
    for (int k = --next_part_; k >= 0; k = --next_part_) {
      (*act_)(k);
      if (--unfinished_ == 0) unfinished_.notify_one();
    }
  }
  void work() {
    for (int seen = 0;;) {
      seen = next_value(round_, seen);
      if (ends_) return;
      take_parts();
    }
  }

  const int threads_;
  const std::function<void(int)>* act_ = nullptr;  // of the round, while a part is unfinished
  std::atomic<bool> ends_ = false;
  std::atomic<int> round_ = 0, unfinished_ = 0, next_part_ = 0;
  std::vector<std::jthread> others_;  // the last member: it ends first
};

/// Of the calling thread, which keeps it for its next loop.
Team& team_of(int threads) {
  thread_local std::unique_ptr<Team> team;
  if (!team || team->threads() != threads) team = std::make_unique<Team>(threads);
  return *team;
}

}  // namespace

void in_parallel(int parts, const std::function<void(int)>& act) {
  std::vector<std::exception_ptr> thrown(static_cast<size_t>(parts));
  team_of(parts).run([&](int k) {
    try {
      act(k);
    } catch (...) {
      thrown[size_t(k)] = std::current_exception();
    }
  });
  for (const std::exception_ptr& one : thrown)
    if (one) std::rethrow_exception(one);
}

namespace {

/// The runs of elements that touch the share's particles.
std::vector<ElementRun> runs_of(const Share& share,
                                const std::vector<std::array<int, 4>>& elements) {
  std::vector<ElementRun> runs;
  for (size_t e = 0; e < elements.size(); ++e) {
    const auto own = std::ranges::count_if(elements[e], [&](int i) { return share.has(i); });
    if (own == 0) continue;
    const bool is_inside = size_t(own) == elements[e].size();
    if (!runs.empty() && runs.back().end == e && runs.back().is_inside == is_inside)
      ++runs.back().end;
    else
      runs.push_back({e, e + 1, is_inside});
  }
  return runs;
}

}  // namespace

Sharing share_out(int threads, Eigen::Index particles,
                  const std::vector<std::array<int, 4>>& elements) {
  if (threads <= 1) return {};
  SharedOut result{elements.size(), {}};
  for (int k = 0; k < threads; ++k) {
    Share share{int(particles * k / threads), int(particles * (k + 1) / threads), {}};
    share.runs = runs_of(share, elements);
    result.shares.push_back(std::move(share));
  }
  return std::make_shared<const SharedOut>(std::move(result));
}

}  // namespace foldproof
