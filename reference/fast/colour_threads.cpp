#include "reference/fast/colour_threads.h"

#include <barrier>
#include <thread>
#include <utility>

namespace foldproof {

namespace {

/// The part of [first, last) that falls to a thread.
std::pair<int, int> part_of(int first, int last, int thread, int threads) {
  const long count = last - first;
  return {first + int(count * thread / threads), first + int(count * (thread + 1) / threads)};
}

}  // namespace

void run_colours_on_threads(const std::vector<int>& colours, int threads,
                            const std::function<void(int first, int last, int thread)>& run) {
  std::barrier colour_done(threads);
  const auto run_parts = [&](int thread) {
    for (size_t c = 0; c + 1 < colours.size(); ++c) {
      const auto [first, last] = part_of(colours[c], colours[c + 1], thread, threads);
      run(first, last, thread);
      colour_done.arrive_and_wait();
    }
  };
  std::vector<std::jthread> others;
  for (int thread = 1; thread < threads; ++thread) others.emplace_back(run_parts, thread);
  run_parts(0);
}

}  // namespace foldproof
