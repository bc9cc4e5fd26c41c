// Sticky patches of a case: surfaces, particles, their selection, and numbers.
#include <catch2/catch.hpp>

#include "reference/scene/object_surface.h"
#include "verification/specimens/scratch_folder.h"
#include "verification/tests/reference/scene/scene_texts.h"

using namespace foldproof;
using Catch::Matchers::Contains;

namespace {

const std::string numbers = "stiffness = 3.5\nforecast_time = 0.02\nnear = 0.01\nfar = 0.04\n";

/// The first sticky patch of the sheet, its keys from line 11 on.
StickyPatch patch(const std::string& keys, const std::string& more = "") {
  return sheet_with("[[sticky]]\n" + keys + more).sticky.at(0);
}

const std::string box_object = "[[object]]\nshape = \"box\"\nsize = [1, 1.5, 2.5]\n";

}  // namespace

TEST_CASE("a sticky patch is named after its surface and number, and refused beyond its limits",
          "[scene]") {
  const std::string one = "[[sticky]]\nsurface = { of = \"cloth\" }\nparticles = {}\n" + numbers;
  const auto read = [&](const std::string& keys) { return sheet_with(one + one + keys); };
  CHECK(read("").sticky.at(1).name == "cloth 2");
  CHECK(read("from = 0.25\nuntil = 0.5\nrelease = 0.25\n").sticky[1].release == 0.25);
  CHECK(read("release = 100\n").sticky[1].release == 100);
  check_refused(read, {{"from = -1e-9\n", "'from' must not be negative"},
                       {"release = -1e-9\n", "'release' must not be negative"},
                       {"from = 0.5\nuntil = 0.5\n", "'until' must be later than 'from'"},
                       {"from = 0.25\nuntil = 0.5\nrelease = 0.2501\n", "'release' must not be"}});
}

TEST_CASE("a region is one of a list, a box and a sphere with their borders, or all", "[scene]") {
  const auto particles = [](const std::string& region) {
    return patch(numbers + "surface = { of = \"cloth\" }\nparticles = {" + region + " }\n")
        .particles;
  };
  using Numbers = std::vector<int>;
  CHECK(particles("particles = [7, 0, 19, 7]") == Numbers{0, 7, 19});
  CHECK(particles("box = [[2.25, 0.75, -1], [2.5, 1, -1]]") == Numbers{5, 6, 9, 10});
  // particle 10 is at (2.5, 1, -1)
  CHECK(particles("sphere = { center = [2.5, 1, -1], radius = 0.25 }") ==
        Numbers{6, 9, 10, 11, 14});
  CHECK(particles("sphere = { center = [2.5, 1, -1], radius = 0.2499 }") == Numbers{10});
  const std::string one = "some.toml:16: give one of 'particles', 'box', 'sphere', 'group'",
                    box = "box = [[0, 0, 0], [1, 1, 1]]",
                    sphere = "sphere = { center = [2.5, 1, -1], radius = 1 }";
  check_refused(particles, {{"particles = [1], " + box, one},
                            {box + ", " + sphere, one},
                            {sphere + ", group = \"a\"", one},
                            {"group = \"a\", particles = [1]", one},
                            {"particles = [20]", "some.toml:16: particle 20 does not exist"}});
}

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
