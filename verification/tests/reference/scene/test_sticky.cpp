// Sticky patches of a case: their numbers, and what triangles and particles mean.
#include <catch2/catch.hpp>

#include "verification/specimens/scratch_folder.h"
#include "verification/tests/reference/scene/scene_texts.h"

using namespace foldproof;
using Catch::Matchers::Contains;

namespace {

const std::string numbers = "stiffness = 3.5\nforecast_time = 0.02\nnear = 0.01\nfar = 0.04\n";

}  // namespace

TEST_CASE("a triangle of a refined cloth means all its parts", "[scene]") {
  const auto refined = [](int times, const std::string& surface) {
    return scene_with("refine = " + std::to_string(times) + "\n[[sticky]]\n" + numbers +
                      "surface = { of = \"cloth\"" + surface +
                      " }\nparticles = { particles = [3] }\n");
  };
  for (const int times : {1, 2}) {
    const Scene scene = refined(times, ", triangles = [1]");
    const int parts = times == 1 ? 4 : 16;
    REQUIRE(int(scene.sticky[0].triangles.size()) == parts);
    for (int k = 0; k < parts; ++k)
      CHECK(scene.sticky[0].triangles[size_t(k)] == scene.mesh.triangles[size_t(parts + k)]);
    CHECK(scene.sticky[0].particles == std::vector<int>{3});
  }
  CHECK_THROWS_WITH(refined(1, ", triangles = [2]"),
                    Contains("triangle 2 does not exist; there are 2"));
}

TEST_CASE("a particle that is listed means its copies, one in a box does not", "[scene]") {
  const ScratchFolder folder;
  folder.write("bow.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 2 1 0\nv 2 2.5 0\nf 1 2 3\nf 3 4 5\n");
  const auto stuck = [&](const std::string& region) {
    const Scene scene = read_scene_text(
        "[cloth]\nmesh = \"bow.obj\"\nrepair = \"split\"\ndensity = 0.2\n[[sticky]]\n" + numbers +
            "surface = { of = \"cloth\" }\nparticles = { " + region +
            " }\n[[hold]]\nparticles = [2, 0]\n[time]\nend = 1\n",
        folder.file("some.toml"));
    CHECK(scene.prescribed.at(2).particle == 5);
    return scene.sticky[0].particles;
  };
  CHECK(stuck("particles = [2, 0]") == std::vector<int>{0, 2, 5});
  CHECK(stuck("particles = [5]") == std::vector<int>{5});
  CHECK(stuck("particles = [5, 2]") == std::vector<int>{2, 5});
  CHECK(stuck("box = [[0, 0, 0], [0.9999, 1, 0]]") == std::vector<int>{0, 2});
}
