// Several runs of one system at once: what a run keeps belongs to it alone.
#include <algorithm>
#include <catch2/catch.hpp>
#include <thread>

#include "verification/specimens/followed_runs.h"

using namespace foldproof;

TEST_CASE("two runs of one system at once have the bits of a run alone") {
  const std::vector<NamedRun> runs = runs_of_all_parts();
  for (const char* name : {"layers", "sticking"}) {
    const NamedRun& of = *std::ranges::find(runs, std::string(name), &NamedRun::name);
    System system = build_system(of.scene);
    set_team(system, 2);
    const auto run = [&] {
      return numbers_after(followed_run(of, system, integrator_named(of.integrator)), 0, 0, 0);
    };
    const Numbers alone = run();
    Numbers first, second;
    {
      const std::jthread one([&] { first = run(); }), other([&] { second = run(); });
    }
    for (const Numbers& numbers : {first, second}) CHECK(bits_that_differ(alone, numbers) == 0);
  }
}
