// A case as a whole: its tables, holds, name, sizes, overflow, and keys for others.
#include <catch2/catch.hpp>

#include "verification/tests/reference/scene/scene_texts.h"

using namespace foldproof;
using Catch::Matchers::Contains;

namespace {

/// The name of the case that a file of this name holds.
std::string name_of(const std::string& file) {
  return read_scene_text(hinge_cloth + "[time]\nend = 1\n", file).name;
}

}  // namespace

TEST_CASE("a case's name has plain letters, digits and '_', '-', '.', 100 at most", "[scene]") {
  for (const std::string& name : {std::string("a"), std::string("azAZ09_-.b"), std::string("q."),
                                  std::string("_"), std::string(100, 'm')})
    CHECK(name_of(name + ".toml") == name);
  for (const std::string& name :
       {std::string("`"), std::string("{"), std::string("@"), std::string("["), std::string("/:"),
        std::string("\xC3\xA9"), std::string(".a"), std::string("-a"), std::string("a..b"),
        std::string(), std::string(101, 'm')})
    check_refused(name_of, {{name + ".toml", name + ".toml: a case is named after its file"}});
}

TEST_CASE("masses and the start must be finite, with the velocities of its holds", "[scene]") {
  const auto dense = [](const std::string& density) {
    return read_scene_text("[cloth]\nshape = \"hinge\"\nlength = 3\nangle = 9\ndensity = " +
                               density + "\n[time]\nend = 1\n",
                           "some.toml");
  };
  CHECK_NOTHROW(dense("1e300"));
  CHECK_THROWS_WITH(dense("1.7e308"), Contains("some.toml:1: a particle has the mass 0"));
  const std::string not_finite = "some.toml:1: a place or velocity at the start",
                    spins = "[start]\nspin = [0, 0, 1.7e308]\n";
  CHECK_NOTHROW(sheet_with("[start]\nstretch = [1, 1.7e308, 1]\nvelocity = [1, 1.7e308, 2]\n"));
  CHECK_NOTHROW(sheet_with(spins + "velocity = [1.7e308, 2, 3]\n"));
  check_refused(
      sheet_with,
      {{spins + "stretch = [1, 1e3, 1]\n", not_finite},
       // before anything else is made of it
       {spins + "stretch = [1, 1e3, 1]\n[[hold]]\nbox = [[0, 0, 0], [1, 1, 1]]\n", not_finite},
       {"[[hold]]\nparticles = [0]\namplitude = [1.7e308, 0, 0]\nfrequency = 3\n", not_finite}});
}
