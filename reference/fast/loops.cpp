#include "reference/fast/loops.h"

#include <atomic>
#include <exception>
#include <thread>

#include "reference/fast/elements.h"

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
class Helpers {
 public:
  explicit Helpers(int threads) : threads_(threads) {
    for (int k = 1; k < threads; ++k) others_.emplace_back([this] { work(); });
  }
  ~Helpers() {
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
Helpers& helpers_of(int threads) {
  thread_local std::unique_ptr<Helpers> helpers;
  if (!helpers || helpers->threads() != threads) helpers = std::make_unique<Helpers>(threads);
  return *helpers;
}

}  // namespace

Team::Team(int threads) : threads_(threads) {
  if (threads < 1) throw InputError("a team needs at least one thread");
}

void in_parallel(int parts, const std::function<void(int)>& act) {
  std::vector<std::exception_ptr> thrown(static_cast<size_t>(parts));
  helpers_of(parts).run([&](int k) {
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

/// The runs of elements that touch an owner's particles.
std::vector<ElementRun> runs_of(const OwnedParticles& owned,
                                const std::vector<std::array<int, 4>>& elements) {
  std::vector<ElementRun> runs;
  for (size_t e = 0; e < elements.size(); ++e) {
    const auto own = std::ranges::count_if(elements[e], [&](int i) { return owned.has(i); });
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

Division divide(const Team& team, Eigen::Index particles,
                const std::vector<std::array<int, 4>>& elements) {
  const int threads = team.threads();
  if (threads == 1) return {};
  DividedElements result{elements.size(), {}};
  for (int k = 0; k < threads; ++k) {
    OwnedParticles owned{int(particles * k / threads), int(particles * (k + 1) / threads), {}};
    owned.runs = runs_of(owned, elements);
    result.owners.push_back(std::move(owned));
  }
  return std::make_shared<const DividedElements>(std::move(result));
}

}  // namespace foldproof
