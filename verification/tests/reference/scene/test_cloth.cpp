// The cloth of a case: shapes, their keys and limits, and its place.
#include <catch2/catch.hpp>

#include "reference/mesh/shapes.h"
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

bool same(const TriangleMesh& a, const TriangleMesh& b) {
  return a.triangles == b.triangles && a.rest.cols() == b.rest.cols() && a.rest == b.rest;
}

void check_limit(const std::string& keys, double triangles, const std::string& key) {
  INFO(keys);
  CHECK_NOTHROW(cloth(keys, triangles));
  CHECK_THROWS_WITH(cloth(keys, triangles - 1), Contains(": '" + key + "' asks for "));
}

const std::string sheet = "shape = \"sheet\"\nwidth = 0.7\nheight = 0.9\ncolumns = 5\nrows = 3\n";

}  // namespace

TEST_CASE("a sheet has the pattern, grading and seed of its keys", "[scene]") {
  const std::vector<std::pair<std::string, SheetPattern>> patterns = {
      {"one_diagonal", SheetPattern::one_diagonal},      {"alternating", SheetPattern::alternating},
      {"union_jack", SheetPattern::union_jack},          {"criss_cross", SheetPattern::criss_cross},
      {"equilateral", SheetPattern::equilateral},        {"jittered", SheetPattern::jittered},
      {"random_delaunay", SheetPattern::random_delaunay}};
  for (const auto& [name, pattern] : patterns) {
    INFO(name);
    const bool jitters = pattern == SheetPattern::jittered;
    const std::string keys =
        sheet + "pattern = \"" + name + "\"\n" + (jitters ? "jitter = 0.2\n" : "");
    const double jitter = jitters ? 0.2 : 0;
    CHECK(same(cloth(keys).mesh, make_sheet({pattern, 0.7, 0.9, 5, 3, jitter, 1, 1})));
    if (jitters || pattern == SheetPattern::random_delaunay)
      CHECK(same(cloth(keys + "seed = 4294967295\n").mesh,
                 make_sheet({pattern, 0.7, 0.9, 5, 3, jitter, 4294967295u, 1})));
  }
  CHECK(same(cloth(sheet + "grading = 1.7\n").mesh,
             make_sheet({SheetPattern::one_diagonal, 0.7, 0.9, 5, 3, 0, 1, 1.7})));
}

TEST_CASE("keys of a cloth are refused beyond their limits, with their place", "[scene]") {
  const std::string row = "shape = \"sheet\"\nwidth = 0.7\nheight = 0.9\nrows = 1\ncolumns = ",
                    statue = "shape = \"statue\"\nheight = -7\n",
                    either = "[cloth] needs either 'shape' or 'mesh'";
  CHECK(cloth(row + "1\n", 1000).mesh.triangles.size() == 2);
  CHECK_NOTHROW(cloth(sheet + "seed = 0\n"));
  check_refused([](const std::string& keys) { return cloth(keys, 1000); },
                {{row + "0\n", "some.toml:6: 'columns' must lie in 1 .. 1,000,000"},
                 {row + "1000001\n", "'columns' must lie in 1 .. 1,000,000"},
                 {row + "1000000\n", "'columns' asks for 3e+06 triangles; 1000 at most are made"},
                 {sheet + "seed = -1\n", "some.toml:7: 'seed' must lie in 0 .. 4294967295"},
                 {sheet + "seed = 4294967296\n", "'seed' must lie in 0 .. 4294967295"},
                 {"shape = \"disc\"\nradius = -1\nrings = 3\n", "some.toml:2: "},
                 {statue + "subdivisions = 1\n", "some.toml:2: make_statue: "},
                 {sheet + "pleats = { columns = 2, angle = 180 }\n", "some.toml:7: "},
                 {sheet + "copies = { count = 2 }\n", "[cloth.copies] needs the key 'move'"},
                 {"", "some.toml:1: " + either},
                 {"shape = \"disc\"\nmesh = \"a.obj\"\n", "some.toml:3: " + either}});
  CHECK_THROWS_WITH(mesh_file(*parse_keys("mesh = \"\"\n", "some.toml"), "", "object"),
                    Contains("--set object.mesh=FILE.obj"));
}

TEST_CASE("each shape is refused where it has more triangles than the limit", "[scene]") {
  check_limit("shape = \"sheet\"\nwidth = 1\nheight = 1\ncolumns = 5\nrows = 3\n", 45, "columns");
  check_limit(sheet + "pattern = \"criss_cross\"\n", 60, "columns");
  check_limit("shape = \"disc\"\nradius = 1\nrings = 3\n", 54, "rings");
  check_limit("shape = \"cylinder\"\nradius = 1\nheight = 1\naround = 5\nalong = 3\n", 30,
              "around");
  check_limit("shape = \"sphere\"\nradius = 1\ndivisions = 3\n", 180, "divisions");
  check_limit("shape = \"sphere\"\nradius = 1\nsubdivisions = 2\n", 320, "subdivisions");
  check_limit(
      "shape = \"hinge\"\nlength = 1\nangle = 9\n"
      "copies = { count = 3, move = [1, 2, 3] }\n",
      6, "count");
}

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
