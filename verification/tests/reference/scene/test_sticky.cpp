// Sticky patches of a case: surfaces, particles, their selection, and numbers.
#include <catch2/catch.hpp>
#include <filesystem>
#include <limits>

#include "reference/scene/object_surface.h"
#include "verification/specimens/scratch_folder.h"
#include "verification/tests/reference/scene/scene_texts.h"

using namespace foldproof;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

namespace {

const std::string numbers = "stiffness = 3.5\nforecast_time = 0.02\nnear = 0.01\nfar = 0.04\n";

/// The first sticky patch of the sheet, its keys from line 11 on.
StickyPatch patch(const std::string& keys, const std::string& more = "") {
  return sheet_with("[[sticky]]\n" + keys + more).sticky.at(0);
}

StickyPatch on_cloth(const std::string& surface, const std::string& particles) {
  return patch(numbers + "surface = { of = \"cloth\"" + surface + " }\nparticles = {" + particles +
               " }\n");
}

StickyPatch numbered_by(const std::string& keys) {
  return patch("surface = { of = \"cloth\" }\nparticles = {}\n" + keys);
}

std::vector<int> counted(int first, int last) {
  std::vector<int> all;
  for (int i = first; i <= last; ++i) all.push_back(i);
  return all;
}

const std::string box_object = "[[object]]\nshape = \"box\"\nsize = [1, 1.5, 2.5]\n";

}  // namespace

TEST_CASE("a sticky patch takes each number of its keys", "[scene]") {
  const StickyPatch full =
      numbered_by(numbers + "name = \"glue\"\nfrom = 0.125\nuntil = 0.625\nrelease = 0.25\n");
  CHECK(full.name == "glue");
  CHECK(full.stiffness == 3.5);
  CHECK(full.forecast_time == 0.02);
  CHECK(full.near == 0.01);
  CHECK(full.far == 0.04);
  CHECK(full.from == 0.125);
  CHECK(full.until == 0.625);
  CHECK(full.release == 0.25);
}

TEST_CASE("sticky patches are named after their surface and number, and hold for ever", "[scene]") {
  const std::string one = "[[sticky]]\nsurface = { of = \"cloth\" }\nparticles = {}\n" + numbers;
  const Scene scene = sheet_with(one + one + "name = \"glue\"\n" + one);
  REQUIRE(scene.sticky.size() == 3);
  CHECK(scene.sticky[0].name == "cloth 1");
  CHECK(scene.sticky[1].name == "glue");
  CHECK(scene.sticky[2].name == "cloth 3");
  CHECK(scene.sticky[0].from == 0);
  CHECK(scene.sticky[0].until == std::numeric_limits<double>::infinity());
  CHECK(scene.sticky[0].release == 0);
  CHECK_FALSE(scene.sticky[0].place);
  CHECK_FALSE(scene.sticky[0].velocity);
}

TEST_CASE("numbers of a sticky patch out of range are refused", "[scene]") {
  const auto refused = [](const std::string& keys, const std::string& message) {
    CHECK_THROWS_WITH(numbered_by(keys), message);
  };
  refused("stiffness = 0\n", "some.toml:13: 'stiffness' must be > 0");
  refused("stiffness = 1\n", "some.toml:10: [sticky] needs the key 'forecast_time'");
  refused("stiffness = 1\nforecast_time = -1e-9\n",
          "some.toml:14: 'forecast_time' must not be negative");
  CHECK(numbered_by("stiffness = 1\nforecast_time = 0\nnear = 1\nfar = 2\n").forecast_time == 0);
  refused("stiffness = 1\nforecast_time = 0\nnear = 0\n", "some.toml:15: 'near' must be > 0");
  refused("stiffness = 1\nforecast_time = 0\nnear = 1\nfar = 0\n",
          "some.toml:16: 'far' must be > 0");
  refused(numbers + "from = -1e-9\n", "some.toml:17: 'from' must not be negative");
  refused(numbers + "release = -1e-9\n", "some.toml:17: 'release' must not be negative");
  refused(numbers + "from = 0.5\nuntil = 0.5\n",
          "some.toml:18: 'until' must be later than 'from', in s");
  CHECK(numbered_by(numbers + "from = 0.5\nuntil = 0.50001\n").until == 0.50001);
  CHECK(numbered_by(numbers + "from = 0.25\nuntil = 0.5\nrelease = 0.25\n").release == 0.25);
  refused(numbers + "from = 0.25\nuntil = 0.5\nrelease = 0.2501\n",
          "some.toml:19: 'release' must not be longer than the time from 'from' to 'until'");
  CHECK(numbered_by(numbers + "release = 100\n").release == 100);
  const std::string needs =
      "some.toml:10: [[sticky]] needs 'surface', what is sticky, and 'particles', what sticks";
  CHECK_THROWS_WITH(patch("surface = { of = \"cloth\" }\n"), needs);
  CHECK_THROWS_WITH(patch("particles = {}\n"), needs);
}

TEST_CASE("a region is a list, a box, a sphere, or all", "[scene]") {
  const auto particles = [](const std::string& region) { return on_cloth("", region).particles; };
  CHECK(particles("") == counted(0, 19));
  CHECK(particles("particles = [7, 0, 19, 7]") == std::vector<int>{0, 7, 19});
  CHECK(particles("box = [[2.25, 0.75, -1], [2.5, 1, -1]]") == std::vector<int>{5, 6, 9, 10});
  // particle 10 is at (2.5, 1, -1): a sphere has its border
  CHECK(particles("sphere = { center = [2.5, 1, -1], radius = 0.25 }") ==
        std::vector<int>{6, 9, 10, 11, 14});
  CHECK(particles("sphere = { center = [2.5, 1, -1], radius = 0.2499 }") == std::vector<int>{10});
  CHECK_THROWS_WITH(particles("sphere = { center = [2.5, 1, -1], radius = 0 }"),
                    "some.toml:16: 'radius' must be > 0");
  const std::string one =
      "some.toml:16: give one of 'particles', 'box', 'sphere', 'group', or none for all";
  const std::string box = "box = [[0, 0, 0], [1, 1, 1]]",
                    sphere = "sphere = { center = [2.5, 1, -1], radius = 1 }";
  CHECK_THROWS_WITH(particles("particles = [1], " + box), one);
  CHECK_THROWS_WITH(particles(box + ", " + sphere), one);
  CHECK_THROWS_WITH(particles(sphere + ", group = \"a\""), one);
  CHECK_THROWS_WITH(particles("group = \"a\", particles = [1]"), one);
  CHECK_THROWS_WITH(particles(box), "some.toml:16: no particles are there");
  CHECK_THROWS_WITH(particles("particles = [20]"),
                    "some.toml:16: particle 20 does not exist; there are 20");
  CHECK_THROWS_WITH(particles("group = \"a\""),
                    "some.toml:16: 'group' names a group of an OBJ file; this is made without one");
}

TEST_CASE("triangles are selected by number or by their middle", "[scene]") {
  const Scene scene = sheet_with("");
  const std::vector<Triangle>& all = scene.mesh.triangles;
  CHECK(on_cloth("", "").triangles == all);
  CHECK(on_cloth(", triangles = [23, 4, 4]", "").triangles ==
        std::vector<Triangle>{all[4], all[23]});
  // the cell from (2.25, 0.75): middles a third of the cell from its sides
  const auto in_cell = on_cloth(", box = [[2.3333, 0.8333, -2], [2.4167, 0.9167, 0]]", "");
  CHECK(in_cell.triangles == std::vector<Triangle>{all[8], all[9]});
  CHECK_THROWS_WITH(on_cloth(", triangles = [24]", ""),
                    "some.toml:15: triangle 24 does not exist; there are 24");
  CHECK_THROWS_WITH(on_cloth(", box = [[0, 0, 0], [1, 1, 1]]", ""),
                    "some.toml:15: no triangles are there");
}

TEST_CASE("a triangle of a refined cloth means all its parts", "[scene]") {
  const auto refined = [](int times, const std::string& surface) {
    return read_scene_text(hinge_cloth + "refine = " + std::to_string(times) + "\n[[sticky]]\n" +
                               numbers + "surface = { of = \"cloth\"" + surface +
                               " }\nparticles = { particles = [3] }\n" + "[time]\nend = 0.7\n",
                           "some.toml");
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
                    "some.toml:12: triangle 2 does not exist; there are 2");
}

TEST_CASE("a patch on an object keeps the vertices in use, where the object takes them",
          "[scene]") {
  const std::string moving = box_object + "velocity = [0.5, 0.25, -1]\nname = \"crate\"\n";
  const StickyPatch glued =
      patch(numbers + "surface = { of = \"crate\", triangles = [3, 2] }\nparticles = {}\n", moving);
  const ObjectSurface box = box_surface({0.5, 0.75, 1.25});
  CHECK(glued.name == "crate 1");
  REQUIRE(glued.triangles.size() == 2);
  REQUIRE(glued.place);
  for (const double t : {0.0, 2.0}) {
    const PerParticle3 place = glued.place(t), velocity = glued.velocity(t);
    CHECK(place.cols() == 4);
    for (size_t k = 0; k < 2; ++k)
      for (size_t corner = 0; corner < 3; ++corner) {
        const Vector3 expected =
            box.vertices.col(box.triangles[2 + k][corner]) + t * Vector3(0.5, 0.25, -1);
        CHECK((place.col(glued.triangles[k][corner]) - expected).norm() < 1e-14);
        CHECK(velocity.col(glued.triangles[k][corner]) == Vector3(0.5, 0.25, -1));
      }
  }
  CHECK_THROWS_WITH(patch(numbers + "surface = { of = \"box\" }\nparticles = {}\n", moving),
                    "some.toml:15: there is nothing named 'box' to stick to; known: cloth, crate");
  CHECK(patch(numbers + "surface = { of = \"box 2\" }\nparticles = {}\n", moving + box_object)
            .triangles.size() == 12);
  // by the middles at the start
  const StickyPatch top = patch(
      numbers + "surface = { of = \"crate\", box = [[0, 0, 1.2], [2, 2, 2]] }\nparticles = {}\n",
      moving + "move = [0.5, 0.5, 0]\n");
  CHECK(top.triangles.size() == 2);
  CHECK(top.place(0).row(2) == Eigen::RowVector4d::Constant(1.25));
  CHECK_THROWS_WITH(
      patch(numbers + "surface = { of = \"crate\", group = \"a\" }\nparticles = {}\n", moving),
      "some.toml:15: 'group' names a group of an OBJ file; this is made without one");
}

TEST_CASE("groups of the cloth's and of an object's file select triangles and corners", "[scene]") {
  const ScratchFolder folder;
  folder.write("cloth.obj",
               "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 1 0\ng left\nf 1 2 3\ng right far\n"
               "f 2 5 3\ng left\nf 1 3 4\n");
  folder.write("solid.obj",
               "v 0 0 5\nv 1 0 5\nv 0 1 5\nv 0 0 6\ng base\nf 1 3 2\ng sides\nf 1 2 4\nf 2 3 4\n"
               "g sides\nf 3 1 4\n");
  const auto read = [&](const std::string& surface, const std::string& particles,
                        const std::string& refine = "") {
    return read_scene_text("[cloth]\nmesh = \"cloth.obj\"\ndensity = 0.2\n" + refine +
                               "\n[[object]]\nshape = \"half_space\"\n[[object]]\n"
                               "mesh = \"solid.obj\"\nfield = \"exact\"\n[[sticky]]\n" +
                               numbers + "surface = { of = " + surface +
                               " }\nparticles = { group = \"" + particles +
                               "\" }\n[time]\nend = 1\n",
                           folder.file("some.toml"));
  };
  const Scene scene = read("\"cloth\", group = \"left\"", "far");
  CHECK(scene.sticky[0].triangles == std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}});
  CHECK(scene.sticky[0].particles == std::vector<int>{1, 2, 4});
  const Scene object = read("\"mesh 2\", group = \"sides\"", "left");
  CHECK(object.sticky[0].triangles.size() == 3);
  CHECK(object.sticky[0].place(0).cols() == 4);
  CHECK(object.sticky[0].particles == std::vector<int>{0, 1, 2, 3});
  CHECK(read("\"mesh 2\", group = \"base\"", "left").sticky[0].place(0).row(2) ==
        Eigen::RowVector3d::Constant(5));
  const Scene refined = read("\"cloth\", group = \"far\"", "far", "refine = 1");
  REQUIRE(refined.sticky[0].triangles.size() == 4);
  for (size_t k = 0; k < 4; ++k)
    CHECK(refined.sticky[0].triangles[k] == refined.mesh.triangles[4 + k]);
  CHECK(refined.sticky[0].particles.size() == 6);
  CHECK_THROWS_WITH(read("\"cloth\", group = \"top\"", "far"),
                    Contains("some.toml:15: there is no group 'top'; known: far, left, right"));
  CHECK_THROWS_WITH(read("\"half_space 1\", group = \"top\"", "far"),
                    Contains("this is made without one"));
  folder.write("cloth.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n");
  CHECK_THROWS_WITH(read("\"cloth\", group = \"top\"", "far"),
                    Contains("there is no group 'top'; known: none"));
}

TEST_CASE("a particle that is listed means its copies, one in a box does not", "[scene]") {
  const ScratchFolder folder;
  folder.write("bow.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 2 1 0\nv 2 2.5 0\nf 1 2 3\nf 3 4 5\n");
  const auto read = [&](const std::string& tables) {
    return read_scene_text("[cloth]\nmesh = \"bow.obj\"\nrepair = \"split\"\ndensity = 0.2\n" +
                               tables + "[time]\nend = 1\n",
                           folder.file("some.toml"));
  };
  const auto stuck = [&](const std::string& region) {
    return read("[[sticky]]\n" + numbers + "surface = { of = \"cloth\" }\nparticles = { " + region +
                " }\n")
        .sticky[0]
        .particles;
  };
  CHECK(stuck("particles = [2, 0]") == std::vector<int>{0, 2, 5});
  CHECK(stuck("particles = [5]") == std::vector<int>{5});
  CHECK(stuck("particles = [5, 2]") == std::vector<int>{2, 5});
  CHECK(stuck("particles = [1]") == std::vector<int>{1});
  CHECK(stuck("box = [[0, 0, 0], [0.9999, 1, 0]]") == std::vector<int>{0, 2});
  const Scene held = read("[[hold]]\nparticles = [2, 0]\n");
  REQUIRE(held.prescribed.size() == 3);
  CHECK(held.prescribed[2].particle == 5);
}

TEST_CASE("a patch on a deforming body follows its frames", "[scene]") {
  const ScratchFolder folder;
  std::filesystem::create_directory(folder.file("frames"));
  folder.write("frames/0.obj",
               "v 0 0 5\nv 1 0 5\nv 0 1 5\nv 0 0 6\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
  folder.write("frames/1.obj",
               "v 0 0 5\nv 1 0 5\nv 0 1 5\nv 0.5 0.25 8\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
  const Scene scene = read_scene_text(
      hinge_cloth +
          "[[object]]\nframes = \"frames\"\ninterval = 0.5\nname = \"body\"\n[[sticky]]\n" +
          numbers + "surface = { of = \"body\", triangles = [1] }\nparticles = {}\n" +
          "[time]\nend = 1\n",
      folder.file("some.toml"));
  const StickyPatch& glued = scene.sticky[0];
  REQUIRE(glued.triangles == std::vector<Triangle>{{0, 1, 2}});
  const PerParticle3 middle = glued.place(0.25), v = glued.velocity(0.25);
  REQUIRE(middle.cols() == 3);
  CHECK((middle.col(0) - Vector3(0, 0, 5)).norm() < 1e-14);
  CHECK((middle.col(1) - Vector3(1, 0, 5)).norm() < 1e-14);
  CHECK((middle.col(2) - Vector3(0.25, 0.125, 7)).norm() < 1e-14);
  CHECK(v.col(0) == Vector3::Zero());
  CHECK(v.col(2) == Vector3(1, 0.5, 4));
  CHECK(glued.place(0.5).col(2) == Vector3(0.5, 0.25, 8));
}
