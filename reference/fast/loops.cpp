#include "reference/fast/loops.h"

#include <algorithm>
#include <exception>
#include <memory>
#ifdef FOLDPROOF_HAS_TBB
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>
#else
#include <thread>
#endif

#include "reference/fast/elements.h"

namespace foldproof {

namespace {

#ifdef FOLDPROOF_HAS_TBB
/// An arena of at most `parts` threads and at most one per core, including the calling thread,
/// which keeps it for its next loop.
tbb::task_arena& arena_of(int parts) {
  const int threads = std::min(parts, tbb::info::default_concurrency());
  thread_local std::unique_ptr<tbb::task_arena> arena;
  if (!arena || arena->max_concurrency() != threads)
    arena = std::make_unique<tbb::task_arena>(threads);
  return *arena;
}

template <class Act>
void run_parts(int parts, const Act& act) {
  arena_of(parts).execute([&] { tbb::parallel_for(0, parts, act, tbb::simple_partitioner()); });
}
#else
/// For builds without oneTBB, and for the thread sanitizer, which cannot see into it. Slow: each
/// loop starts new threads.
template <class Act>
void run_parts(int parts, const Act& act) {
  std::vector<std::jthread> others;
  for (int k = 1; k < parts; ++k) others.emplace_back([&act, k] { act(k); });
  act(0);
}
#endif

}  // namespace

Team::Team(int threads) : threads_(threads) {
  if (threads < 1) throw InputError("a team needs at least one thread");
}

void in_parallel(int parts, const std::function<void(int)>& act) {
  std::vector<std::exception_ptr> thrown(static_cast<size_t>(parts));
  run_parts(parts, [&](int from_last) {
    // The last part runs first, so results that depend on the order differ even on one core.
    const int k = parts - 1 - from_last;
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
