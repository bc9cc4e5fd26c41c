// Numbers in files that readers refuse: too large, or not representable as a double.
#include <catch2/catch.hpp>

#include "reference/level_set/grid.h"
#include "reference/mesh/mesh_file.h"
#include "reference/scene/scene.h"
#include "verification/specimens/check.h"

using namespace foldproof;
using Catch::Matchers::Contains;

namespace {

Scene cloth_of(const std::string& keys) {
  return read_scene_text("[cloth]\ndensity = 0.2\nshape = \"" + keys + "[time]\nend = 1\n",
                         "some.toml");
}

const std::string hinge = "hinge\"\nlength = 1\nangle = 9\n";

}  // namespace

TEST_CASE("a cloth of too many triangles, or of numbers that no double holds, is refused") {
  for (const auto& [keys, words] : std::vector<std::pair<std::string, std::string>>{
           {"sheet\"\nwidth = 1\nheight = 1\ncolumns = 1000000\nrows = 1000000\n", "3e+12 tri"},
           {"disc\"\nradius = 1\nrings = 10000\n", "'rings' asks for 6e+08"},
           {"cylinder\"\nradius = 1\nheight = 1\naround = 10000\nalong = 10000\n", "for 2e+08"},
           {"sphere\"\nradius = 1\nsubdivisions = 1000000\n", "'subdivisions' asks for inf"},
           {hinge + "copies = { count = 1000000000, move = [1, 0, 0] }\n", "must lie in"},
           {"disc\"\nradius = 1\nrings = 20\ncopies = { count = 1000000, move = [1, 0, 0] }\n",
            "some.toml:6: 'count' asks for 2.4e+09 triangles"},
           {hinge + "fit = 1e-200\n", "some.toml:1: a particle has the mass 0"},
           {hinge + "fit = 1e200\n", "some.toml:1: a particle has the mass 0"},
           {hinge + "fit = 1.7e308\nmove = [1.7e308, 0, 0]\n", "is not finite"},
           {hinge + "[[object]]\nshape = \"sphere\"\nradius = 1.7e308\nmove = [1.7e308, 0, 0]\n",
            "some.toml:6: a place of its surface is not finite"}}) {
    INFO(keys);
    CHECK_THROWS_WITH(cloth_of(keys), Contains(words));
  }
  std::string record = "g";
  for (int k = 0; k <= 100; ++k) record += " n" + std::to_string(k);
  CHECK_THROWS_WITH(read_mesh_text("v 0 0 0\n" + record + "\n", "some.obj"),
                    Contains("some.obj:2: more than 16 names"));
}

TEST_CASE("coordinates whose areas would overflow or vanish are refused with their place") {
  const auto said = [](const std::string& number) {
    const std::string v = "v " + number + " 0 0\n";
    return rejection_message(
        [&] { read_mesh_text("v 0 0 0\nv 0 1e-80 0\n" + v + "f 1 2 3\n", "some.obj"); });
  };
  for (const char* number : {"9e74", "-9e74", "2e-75"}) CHECK(said(number) == "");
  for (const char* number : {"2e75", "-2e75", "1e300"})
    CHECK_THAT(said(number), Contains("some.obj:3: a coordinate is too large, beyond 1e75 m"));
  CHECK_THAT(said("5e-76"), Contains("some.obj: no coordinate is as large as 1e-75 m"));
}

TEST_CASE("level sets of more cells than a machine holds are refused with the place of the key") {
  const std::string body =
      "[[object]]\nshape = \"statue\"\nheight = 1\nsubdivisions = 3\ncells = 1000000000\n";
  CHECK_THROWS_WITH(build_system(cloth_of(hinge + body)),
                    Contains("some.toml:10: grid: 1000000000 cells"));
  CHECK_THROWS_WITH(cloth_of(hinge + body + "field = \"octree\"\n"),
                    Contains("some.toml:10: 'cells' must be"));
}

TEST_CASE("a lattice whose nodes cannot be counted is refused") {
  const Bounds unit{Vector3::Zero(), Vector3::Ones()};
  CHECK_THROWS_WITH(lattice_about(unit, 1'000'000'000, 3), Contains("at most 2^20"));
  CHECK_THROWS_WITH(lattice_about(unit, 1 << 20, 3), Contains("2^30 nodes at most"));
}
