// The cloth of a case: limits of its shapes, and seams.
#include <catch2/catch.hpp>

#include "reference/scene/read_cloth_mesh.h"
#include "verification/specimens/scratch_folder.h"
#include "verification/tests/reference/scene/scene_texts.h"

using namespace foldproof;
using Catch::Matchers::Contains;

namespace {

/// Keys begin on line 2.
PlacedMesh cloth(const std::string& keys, double most = 1e7, const std::string& folder = "") {
  return read_cloth_mesh(*parse_keys("[cloth]\n" + keys, "some.toml")->table("cloth"), folder,
                         {most, 1000});
}

}  // namespace

TEST_CASE("seams are sewn before fans are split, and splits are recorded", "[scene]") {
  const ScratchFolder folder;
  // two triangles meet in vertex 3, a third lies a thousandth beside the second
  const std::string bow = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 2 1 0\nv 2 2.5 0\nf 1 2 3\nf 3 4 5\n";
  folder.write("bow.obj", bow);
  folder.write("panels.obj", bow + "v 2.001 1 0\nv 2.001 2.5 0\nv 3 1 0\nf 6 8 7\n");
  const auto read = [&](const std::string& file, const std::string& keys) {
    return cloth("mesh = \"" + file + ".obj\"\n" + keys, 1e7, folder.file(""));
  };
  CHECK_THROWS_WITH(read("bow", ""), Contains(folder.file("bow.obj")));
  CHECK_THROWS_WITH(read("bow", "repair = \"mend\"\n"), Contains("known: refuse, split"));
  const PlacedMesh split = read("bow", "repair = \"split\"\n");
  CHECK(split.copy_of == std::vector<int>{0, 1, 2, 3, 4, 2});
  CHECK(split.start.cols() == 6);
  CHECK(split.mesh.triangles == std::vector<Triangle>{{0, 1, 2}, {5, 3, 4}});
  const PlacedMesh sewn = read("panels", "repair = \"split\"\nseams = 0.002\n");
  CHECK(sewn.start.cols() == 7);
  CHECK(sewn.mesh.hinges.size() == 1);
  CHECK(read("bow", "repair = \"split\"\ncopies = { count = 2, move = [9, 0, 0] }\n").copy_of ==
        std::vector<int>{0, 1, 2, 3, 4, 2, 6, 7, 8, 9, 10, 8});
}
