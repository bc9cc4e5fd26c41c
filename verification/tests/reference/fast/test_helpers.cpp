// The threads that help a caller with its loops: how many there are, and what they do meanwhile.
#include <barrier>
#include <catch2/catch.hpp>
#include <chrono>
#include <ctime>
#include <set>
#include <thread>
#include <vector>

#include "reference/fast/loops.h"

using namespace foldproof;

namespace {

using Ids = std::set<std::thread::id>;

/// The threads of a loop whose parts are under way at once.
Ids threads_of_loop(int parts) {
  std::barrier all_have_begun(parts);
  std::vector<std::thread::id> ids(static_cast<size_t>(parts));
  in_parallel(parts, [&](int k) {
    all_have_begun.arrive_and_wait();
    ids[size_t(k)] = std::this_thread::get_id();
  });
  return {ids.begin(), ids.end()};
}

}  // namespace

TEST_CASE("threads: a caller has one helper less than a loop has parts") {
  Ids threads;
  for (int loop = 0; loop < 40; ++loop) threads.merge(threads_of_loop(3));
  CHECK(threads.size() == 3);
  CHECK(threads.contains(std::this_thread::get_id()));
}

TEST_CASE("threads: helpers sleep between loops, and wake for the next") {
  const Ids threads = threads_of_loop(3);
  const std::clock_t before = std::clock();
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  const double busy = double(std::clock() - before) / CLOCKS_PER_SEC;  // of all threads [s]
  CHECK(busy < 0.02);
  CHECK(threads_of_loop(3) == threads);
}
