// The cloth of a case: shapes, their keys and limits, and its place.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "reference/mesh/obj.h"
#include "reference/mesh/shapes.h"
#include "reference/mesh/split_fans.h"
#include "reference/scene/read_cloth_mesh.h"
#include "verification/specimens/scratch_folder.h"

using namespace foldproof;
using Catch::Matchers::Contains;
using Catch::Matchers::EndsWith;
using Catch::Matchers::StartsWith;

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

TEST_CASE("a sheet has each key of its case, in each pattern", "[scene]") {
  const std::vector<std::pair<std::string, SheetPattern>> patterns = {
      {"one_diagonal", SheetPattern::one_diagonal},      {"alternating", SheetPattern::alternating},
      {"union_jack", SheetPattern::union_jack},          {"criss_cross", SheetPattern::criss_cross},
      {"equilateral", SheetPattern::equilateral},        {"jittered", SheetPattern::jittered},
      {"random_delaunay", SheetPattern::random_delaunay}};
  for (const auto& [name, pattern] : patterns) {
    INFO(name);
    const bool is_random =
        pattern == SheetPattern::jittered || pattern == SheetPattern::random_delaunay;
    Sheet expected{pattern, 0.7, 0.9, 5, 3, 0, 1, 1};
    if (pattern == SheetPattern::jittered) expected.jitter = 0.2;
    const std::string jitter = pattern == SheetPattern::jittered ? "jitter = 0.2\n" : "";
    const std::string keys = sheet + "pattern = \"" + name + "\"\n" + jitter;
    CHECK(same(cloth(keys).mesh, make_sheet(expected)));
    if (!is_random) continue;
    expected.seed = 29;
    CHECK(same(cloth(keys + "seed = 29\n").mesh, make_sheet(expected)));
    CHECK_FALSE(same(cloth(keys + "seed = 29\n").mesh, cloth(keys).mesh));
  }
  CHECK(same(cloth(sheet).mesh, make_sheet({SheetPattern::one_diagonal, 0.7, 0.9, 5, 3, 0, 1, 1})));
  CHECK(same(cloth(sheet + "grading = 1.7\n").mesh,
             make_sheet({SheetPattern::one_diagonal, 0.7, 0.9, 5, 3, 0, 1, 1.7})));
  CHECK(same(cloth(sheet + "pattern = \"jittered\"\n").mesh,
             make_sheet({SheetPattern::jittered, 0.7, 0.9, 5, 3, 0, 1, 1})));
  CHECK_THROWS_WITH(cloth(sheet + "pattern = \"herringbone\"\n"),
                    "some.toml:7: unknown pattern 'herringbone'; known: one_diagonal, alternating, "
                    "union_jack, criss_cross, equilateral, jittered, random_delaunay");
}

TEST_CASE("counts of a sheet lie in 1 to 1,000,000, a seed in 32 bits", "[scene]") {
  const auto counted = [](const std::string& columns) {
    return cloth(
        "shape = \"sheet\"\nwidth = 0.7\nheight = 0.9\nrows = 1\ncolumns = " + columns + "\n",
        1000);
  };
  CHECK(counted("1").mesh.triangles.size() == 2);
  CHECK_THROWS_WITH(counted("0"), "some.toml:6: 'columns' must lie in 1 .. 1,000,000");
  CHECK_THROWS_WITH(counted("1000001"), "some.toml:6: 'columns' must lie in 1 .. 1,000,000");
  CHECK_THROWS_WITH(counted("1000000"),
                    "some.toml:6: 'columns' asks for 3e+06 triangles; 1000 at most are made");
  CHECK_NOTHROW(cloth(sheet + "seed = 0\n"));
  CHECK_NOTHROW(cloth(sheet + "seed = 4294967295\n"));
  CHECK_THROWS_WITH(cloth(sheet + "seed = -1\n"),
                    "some.toml:7: 'seed' must lie in 0 .. 4294967295");
  CHECK_THROWS_WITH(cloth(sheet + "seed = 4294967296\n"),
                    "some.toml:7: 'seed' must lie in 0 .. 4294967295");
  const std::string random = sheet + "pattern = \"random_delaunay\"\n";
  CHECK(same(cloth(random + "seed = 4294967295\n").mesh,
             make_sheet({SheetPattern::random_delaunay, 0.7, 0.9, 5, 3, 0, 4294967295u, 1})));
}

TEST_CASE("shapes are made by their keys", "[scene]") {
  CHECK(same(cloth("shape = \"disc\"\nradius = 0.7\nrings = 3\n").mesh, make_disc(0.7, 3)));
  CHECK(
      same(cloth("shape = \"cylinder\"\nradius = 0.7\nheight = 0.9\naround = 5\nalong = 3\n").mesh,
           make_cylinder(0.7, 0.9, 5, 3)));
  CHECK(same(cloth("shape = \"sphere\"\nradius = 0.7\nsubdivisions = 2\n").mesh,
             make_icosphere(0.7, 2)));
  CHECK(same(cloth("shape = \"sphere\"\nradius = 0.7\ndivisions = 3\n").mesh,
             make_geodesic_sphere(0.7, 3)));
  CHECK(same(cloth("shape = \"sphere\"\nradius = 0.7\ndivisions = 1\n").mesh,
             make_geodesic_sphere(0.7, 1)));
  CHECK(same(cloth("shape = \"hinge\"\nlength = 0.7\nangle = 36\n").mesh,
             make_hinge(0.7, 36 * (pi / 180))));
  CHECK_THROWS_WITH(
      cloth("shape = \"cube\"\n"),
      "some.toml:2: unknown shape 'cube'; known: sheet, disc, cylinder, sphere, statue, hinge");
  CHECK_THROWS_WITH(cloth("shape = \"disc\"\nradius = -1\nrings = 3\n"),
                    StartsWith("some.toml:2: ") && Contains("radius"));
  CHECK_THROWS_WITH(cloth("shape = \"sphere\"\nradius = 0.7\nsubdivisions = 2\ndivisions = 3\n"),
                    "some.toml:5: give 'subdivisions' or 'divisions', not both");
  // statues take long to make, and name what they refuse
  const auto statue = [](const std::string& height, const std::string& fineness) {
    return cloth("shape = \"statue\"\nheight = " + height + "\n" + fineness + "\n");
  };
  CHECK_THROWS_WITH(statue("0.7", "subdivisions = 2"),
                    StartsWith("some.toml:2: make_statue: subdivisions is 2; "));
  CHECK_THROWS_WITH(statue("0.7", "divisions = 1"),
                    StartsWith("some.toml:2: make_even_statue: divisions is 1; "));
  CHECK_THROWS_WITH(statue("-7", "subdivisions = 3"),
                    StartsWith("some.toml:2: make_statue: height is -7; "));
  CHECK_THROWS_WITH(statue("-7", "divisions = 15"),
                    StartsWith("some.toml:2: make_even_statue: height is -7; "));
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

TEST_CASE("a cloth is scaled, then turned about the origin, then moved", "[scene]") {
  const std::string keys = "shape = \"sheet\"\nwidth = 2\nheight = 3\ncolumns = 2\nrows = 3\n";
  const PlacedMesh placed =
      cloth(keys + "fit = 6\nturn = { axis = [0, 0, 2], angle = 90 }\nmove = [10, 20, 30]\n");
  // scaled by 2, (x, y) becomes (-y, x)
  const PerParticle3 plain = cloth(keys).start;
  for (Eigen::Index i = 0; i < plain.cols(); ++i) {
    const Vector3 expected(10 - 2 * plain(1, i), 20 + 2 * plain(0, i), 30);
    CHECK((placed.start.col(i) - expected).norm() < 1e-14);
  }
  CHECK(placed.mesh.rest == placed.start);
  CHECK(plain == make_sheet({SheetPattern::one_diagonal, 2, 3, 2, 3, 0, 1, 1}).rest);
  CHECK_THROWS_WITH(cloth(keys + "fit = 0\n"), "some.toml:7: 'fit' must be > 0 m");
  CHECK_NOTHROW(cloth(keys + "fit = 1e-3\n"));
}

TEST_CASE("the size that is fitted is the largest extent", "[scene]") {
  PerParticle3 x(3, 3);
  x << 5, 6, 5.5,    //
      -2, -2.25, 2,  //
      7, 8.5, 7;
  const auto keys = parse_keys("fit = 8.5\n", "some.toml");
  CHECK(fit_factor(*keys, x) == 2);
  CHECK(fit_factor(*parse_keys("", "some.toml"), x) == 1);
  PerParticle3 scaled = x;
  scale_to_fit(*keys, scaled);
  CHECK(scaled == 2 * x);
}

TEST_CASE("pleats fold the rest shape, and the start if it is not to be flat", "[scene]") {
  const std::string keys =
      "shape = \"sheet\"\nwidth = 2\nheight = 3\ncolumns = 6\nrows = 3\nmove = [10, 20, 30]\n";
  const TriangleMesh plain = make_sheet({SheetPattern::one_diagonal, 2, 3, 6, 3, 0, 1, 1});
  const PerParticle3 folded = pleated_positions(plain, 2, 27 * (pi / 180));
  const auto moved = [](const PerParticle3& x) {
    return PerParticle3(x.colwise() + Vector3(10, 20, 30));
  };
  for (const char* flat : {"", ", start_flat = true"}) {
    const PlacedMesh placed = cloth(keys + "pleats = { columns = 2, angle = 27" + flat + " }\n");
    CHECK(placed.mesh.rest == folded);
    CHECK(placed.start == moved(plain.rest));
  }
  const PlacedMesh placed =
      cloth(keys + "pleats = { columns = 2, angle = 27, start_flat = false }\n");
  CHECK(placed.mesh.rest == folded);
  CHECK(placed.start == moved(folded));
  CHECK_THROWS_WITH(cloth(keys + "fit = 3\npleats = { columns = 2, angle = 27 }\n"),
                    "some.toml:8: 'fit' does not go with pleats");
  CHECK_THROWS_WITH(cloth(keys + "pleats = { columns = 2, angle = 180 }\n"),
                    StartsWith("some.toml:8: "));
}

TEST_CASE("copies are moved, and turned about their middle, on from the one before", "[scene]") {
  const std::string keys = "shape = \"hinge\"\nlength = 1\nangle = 30\n";
  const TriangleMesh one = make_hinge(1, pi / 6);
  const Vector3 middle = one.rest.rowwise().mean(), move(2, 3, 5);
  const PlacedMesh placed = cloth(
      keys + "copies = { count = 3, move = [2, 3, 5], turn = { axis = [0, 0, 1], angle = 40 } }\n");
  REQUIRE(placed.start.cols() == 12);
  for (int c = 0; c < 3; ++c) {
    const Eigen::AngleAxisd turn(c * 2 * pi / 9, Vector3::UnitZ());
    for (int i = 0; i < 4; ++i) {
      const Vector3 expected = turn * (one.rest.col(i) - middle) + middle + c * move;
      CHECK((placed.start.col(4 * c + i) - expected).norm() < 1e-14);
    }
  }
  CHECK(placed.mesh.rest == placed.start);
  CHECK(placed.mesh.triangles.size() == 6);
  for (size_t t = 0; t < 6; ++t)
    for (size_t k = 0; k < 3; ++k)
      CHECK(placed.mesh.triangles[t][k] == int(t) / 2 * 4 + one.triangles[t % 2][k]);
  CHECK(placed.copy_of.empty());
  CHECK(cloth(keys + "copies = { count = 1, move = [2, 3, 5] }\n").start == one.rest);
  CHECK_THROWS_WITH(cloth(keys + "copies = { count = 2 }\n"),
                    "some.toml:5: [cloth.copies] needs the key 'move'");
}

TEST_CASE("copies of pleats lie apart at rest too", "[scene]") {
  const PlacedMesh placed = cloth(
      "shape = \"sheet\"\nwidth = 2\nheight = 3\ncolumns = 2\nrows = 1\nmove = [7, 0, 0]\n"
      "pleats = { columns = 1, angle = 27 }\ncopies = { count = 2, move = [2, 3, 5] }\n");
  REQUIRE(placed.start.cols() == 12);
  for (int i = 0; i < 6; ++i) {
    CHECK((placed.start.col(6 + i) - placed.start.col(i) - Vector3(2, 3, 5)).norm() < 1e-14);
    CHECK((placed.mesh.rest.col(6 + i) - placed.mesh.rest.col(i) - Vector3(2, 3, 5)).norm() <
          1e-14);
  }
  CHECK(placed.start(0, 0) == 7);
  CHECK(placed.mesh.rest(0, 0) == 0);
}

TEST_CASE("a cloth is a shape or a mesh, whose file is there", "[scene]") {
  const std::string either = ": [cloth] needs either 'shape' or 'mesh' (an OBJ file), and not both";
  CHECK_THROWS_WITH(cloth(""), "some.toml:1" + either);
  CHECK_THROWS_WITH(cloth("shape = \"disc\"\nmesh = \"a.obj\"\n"), "some.toml:3" + either);
  const ScratchFolder folder;
  CHECK_THROWS_WITH(cloth("\nmesh = \"a.obj\"\n", 1e7, folder.file("")),
                    "some.toml:3: there is no mesh file '" + folder.file("a.obj") + "'");
  CHECK_THROWS_WITH(cloth("\nmesh = \"\"\n"),
                    "some.toml:3: this case takes a mesh of yours: --set cloth.mesh=FILE.obj");
  CHECK_THROWS_WITH(mesh_file(*parse_keys("mesh = \"\"\n", "some.toml"), "", "object"),
                    "some.toml:1: this case takes a mesh of yours: --set object.mesh=FILE.obj");
}

TEST_CASE("seams are sewn before fans are split, and splits are recorded", "[scene]") {
  const ScratchFolder folder;
  // two triangles meet in vertex 3, a third lies a thousandth beside the second
  const std::string bow = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 2 1 0\nv 2 2.5 0\nf 1 2 3\nf 3 4 5\n",
                    panels = "v 2.001 1 0\nv 2.001 2.5 0\nv 3 1 0\nf 6 8 7\n";
  folder.write("bow.obj", bow);
  folder.write("panels.obj", bow + panels);
  folder.write("plain.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n");
  const auto read = [&](const std::string& file, const std::string& keys) {
    return cloth("mesh = \"" + file + ".obj\"\n" + keys, 1e7, folder.file(""));
  };
  CHECK_THROWS_WITH(read("bow", ""), StartsWith(folder.file("bow.obj")));
  CHECK_THROWS_WITH(read("bow", "repair = \"refuse\"\n"), StartsWith(folder.file("bow.obj")));
  CHECK_THROWS_WITH(read("bow", "repair = \"mend\"\n"),
                    "some.toml:3: unknown repair 'mend'; known: refuse, split");
  const PlacedMesh split = read("bow", "repair = \"split\"\n");
  CHECK(split.copy_of == std::vector<int>{0, 1, 2, 3, 4, 2});
  CHECK(split.start.cols() == 6);
  CHECK(split.mesh.triangles == std::vector<Triangle>{{0, 1, 2}, {5, 3, 4}});
  CHECK(read("plain", "repair = \"split\"\n").copy_of.empty());
  CHECK(read("plain", "").copy_of.empty());
  CHECK(read("panels", "repair = \"split\"\n").start.cols() == 9);
  const PlacedMesh sewn = read("panels", "repair = \"split\"\nseams = 0.002\n");
  CHECK(sewn.start.cols() == 7);
  CHECK(sewn.mesh.triangles.size() == 3);
  CHECK(sewn.mesh.hinges.size() == 1);
  CHECK_THROWS_WITH(read("plain", "seams = 0\n"), "some.toml:3: 'seams' must be > 0");
  const PlacedMesh twice =
      read("bow", "repair = \"split\"\ncopies = { count = 3, move = [9, 0, 0] }\n");
  CHECK(twice.copy_of ==
        std::vector<int>{0, 1, 2, 3, 4, 2, 6, 7, 8, 9, 10, 8, 12, 13, 14, 15, 16, 14});
}
