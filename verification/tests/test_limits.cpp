// Numbers in files that readers refuse: too large, or not representable as a double.
#include <catch2/catch.hpp>

#include "reference/level_set/grid.h"
#include "reference/mesh/obj.h"
#include "reference/scene/scene.h"
#include "verification/seeds.h"

using namespace foldproof;
using Catch::Matchers::Contains;

namespace {

const std::string time_table = "[time]\nend = 1\n";

Scene cloth_of(const std::string& keys) {
  return read_scene_text("[cloth]\ndensity = 0.2\n" + keys + time_table, "some.toml");
}

std::string sheet_of(const std::string& columns, const std::string& more) {
  return "shape = \"sheet\"\nwidth = 1\nheight = 1\ncolumns = " + columns + "\nrows = 1000000\n" +
         more;
}

}  // namespace

TEST_CASE("a cloth of more triangles than a machine holds is refused before it is made") {
  CHECK_THROWS_WITH(cloth_of(sheet_of("1000000", "")),
                    Contains("some.toml:6: 'columns' asks for 3e+12 triangles"));
  CHECK_THROWS_WITH(cloth_of("shape = \"disc\"\nradius = 1\nrings = 10000\n"),
                    Contains("'rings' asks for 6e+08"));
  CHECK_THROWS_WITH(
      cloth_of("shape = \"cylinder\"\nradius = 1\nheight = 1\naround = 10000\nalong = 10000\n"),
      Contains("'around' asks for 2e+08"));
  CHECK_THROWS_WITH(cloth_of("shape = \"sphere\"\nradius = 1\nsubdivisions = 1000000\n"),
                    Contains("'subdivisions' asks for inf"));
  CHECK_THROWS_WITH(cloth_of("shape = \"hinge\"\nlength = 1\nangle = 9\ncopies = { count = "
                             "1000000000, move = [1, 0, 0] }\n"),
                    Contains("'count' must lie in"));
  CHECK_THROWS_WITH(cloth_of("shape = \"disc\"\nradius = 1\nrings = 20\n[cloth.copies]\ncount = "
                             "1000000\nmove = [1, 0, 0]\n"),
                    Contains("some.toml:7: 'count' asks for 2.4e+09 triangles"));
}

TEST_CASE("numbers of a case that come to more than a double holds are refused with their place") {
  const std::string hinge = "shape = \"hinge\"\nlength = 1\nangle = 9\n";
  CHECK_THROWS_WITH(cloth_of(hinge + "fit = 1e-200\n"),
                    Contains("some.toml:1: a particle has the mass 0"));
  CHECK_THROWS_WITH(cloth_of(hinge + "fit = 1e200\n"),
                    Contains("some.toml:1: a particle has the mass 0"));
  CHECK_THROWS_WITH(cloth_of(hinge + "fit = 1.7e308\nmove = [1.7e308, 0, 0]\n"),
                    Contains("is not finite"));
  CHECK_THROWS_WITH(
      cloth_of(hinge +
               "[[object]]\nshape = \"sphere\"\nradius = 1.7e308\nmove = [1.7e308, 0, 0]\n"),
      Contains("some.toml:6: a place of its surface is not finite"));
}

TEST_CASE("a record with more names than groups need is refused") {
  std::string record = "g";
  for (int k = 0; k <= 100; ++k) record += " n" + std::to_string(k);
  CHECK_THROWS_WITH(read_obj_groups_text("v 0 0 0\n" + record + "\n", "some.obj"),
                    Contains("some.obj:2: more than 16 names"));
}

TEST_CASE("level sets of more cells than a machine holds are refused with the place of the key") {
  const std::string cloth = "shape = \"hinge\"\nlength = 1\nangle = 9\n";
  const std::string body =
      "[[object]]\nshape = \"statue\"\nheight = 1\nsubdivisions = 3\ncells = 1000000000\n";
  CHECK_THROWS_WITH(build_system(cloth_of(cloth + body)),
                    Contains("some.toml:10: grid: 1000000000 cells"));
  CHECK_THROWS_WITH(cloth_of(cloth + body + "field = \"octree\"\n"),
                    Contains("some.toml:10: 'cells' must be"));
}

TEST_CASE("a lattice whose nodes cannot be counted is refused") {
  const Bounds unit{Vector3::Zero(), Vector3::Ones()};
  CHECK_THROWS_WITH(lattice_about(unit, 1'000'000'000, 3), Contains("at most 2^20"));
  CHECK_THROWS_WITH(lattice_about(unit, 1 << 20, 3), Contains("2^30 nodes at most"));
}

TEST_CASE("seeds are their own unless they are shifted, and shifts give different ones") {
  CHECK(shifted_seed(77) == 77);
  seed_shift = 1;
  const unsigned first = shifted_seed(77);
  seed_shift = 2;
  CHECK(first != 77);
  CHECK(shifted_seed(77) != first);
  seed_shift = 0;
}
