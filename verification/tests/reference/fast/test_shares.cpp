// How loops are shared out among threads.
#include <array>
#include <barrier>
#include <catch2/catch.hpp>
#include <vector>

#include "reference/fast/loops.h"

using namespace foldproof;

TEST_CASE("threads: all parts of a loop are under way at once") {
  for (const int parts : {2, 3}) {
    std::barrier all_have_begun(parts);  // for which fewer threads would wait for ever
    in_parallel(parts, [&](int) { all_have_begun.arrive_and_wait(); });
    SUCCEED();
  }
}

TEST_CASE("threads: a share has the elements that touch its particles, in runs of one kind") {
  // elements of two, two, two and four particles; of the two shares the first has particles 0 to 2
  const Sharing sharing =
      share_out(2, 6, {{0, 1, 0, 1}, {1, 2, 1, 2}, {4, 5, 4, 5}, {0, 2, 3, 4}, {2, 5, 2, 5}});
  CHECK(sharing->elements == 5);
  const auto runs_of = [&](size_t share) {
    std::vector<std::array<size_t, 3>> runs;
    for (const ElementRun& run : sharing->shares.at(share).runs)
      runs.push_back({run.first, run.end, size_t(run.is_inside)});
    return runs;
  };
  CHECK(runs_of(0) == std::vector<std::array<size_t, 3>>{{0, 2, 1}, {3, 5, 0}});
  CHECK(runs_of(1) == std::vector<std::array<size_t, 3>>{{2, 3, 1}, {3, 5, 0}});
  CHECK(sharing->shares[0].first == 0);
  CHECK(sharing->shares[0].end == 3);
  CHECK(sharing->shares[1].end == 6);
  CHECK_FALSE(share_out(1, 6, {}));
}
