// Changes to the cloth before time 0: folding; and finer triangles.
#include <catch2/catch.hpp>

#include "verification/tests/reference/scene/scene_texts.h"

using namespace foldproof;
using Catch::Matchers::Contains;

TEST_CASE("layers nearer than the rounding of their places are refused at the start", "[scene]") {
  const auto read = [](const std::string& apart) {
    return read_scene_text(
        "[cloth]\ndensity = 0.2\nshape = \"sheet\"\nwidth = 0.3\nheight = 0.3\ncolumns = 6\n"
        "rows = 6\ncopies = { count = 2, move = [0.02, 0.02, " +
            apart + "] }\n[self_collision]\nthickness = 0.002\n[time]\nend = 0.7\n",
        "some.toml");
  };
  for (const char* near : {"1e-18", "1e-17", "1e-16"})
    CHECK_THROWS_WITH(read(near), Contains("some.toml:9: layers of the cloth touch at the start") &&
                                      Contains("nearer than 5.7e-16 m"));
  for (const char* apart : {"1e-15", "0.001"}) CHECK(read(apart).warnings.empty());
  CHECK(read("0").warnings.size() == 1);  // they cross, by the exact test, and are reported
}
