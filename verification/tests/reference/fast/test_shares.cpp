// Loops on several threads at once.
#include <barrier>
#include <catch2/catch.hpp>

#include "reference/fast/loops.h"

using namespace foldproof;

TEST_CASE("threads: all parts of a loop are under way at once") {
  for (const int parts : {2, 3}) {
    std::barrier all_have_begun(parts);  // for which fewer threads would wait for ever
    in_parallel(parts, [&](int) { all_have_begun.arrive_and_wait(); });
    SUCCEED();
  }
}
