// A case as a whole: holds, names, sizes, overflow, and keys for others.
#include <catch2/catch.hpp>
#include <filesystem>

#include "reference/mesh/shapes.h"
#include "verification/specimens/scratch_folder.h"
#include "verification/tests/reference/scene/scene_texts.h"

using namespace foldproof;
using Catch::Matchers::Contains;
using Catch::Matchers::EndsWith;
using Catch::Matchers::StartsWith;

namespace {

std::vector<int> held(const Scene& scene) {
  std::vector<int> particles;
  for (const PrescribedParticle& p : scene.prescribed) particles.push_back(p.particle);
  return particles;
}

std::string refusal(const std::string& tables) {
  try {
    sheet_with(tables);
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

/// What is said of a case file of this name.
std::string said_of(const std::string& name) {
  try {
    return read_scene_text(hinge_cloth + "[time]\nend = 1\n", name).name;
  } catch (const InputError& error) {
    return error.what();
  }
}

}  // namespace

TEST_CASE("a hold's particles are those listed, in a box, or near the top", "[scene]") {
  CHECK(held(sheet_with("[[hold]]\nparticles = [7, 0, 19]\n")) == std::vector<int>{7, 0, 19});
  // a box has its border
  CHECK(held(sheet_with("[[hold]]\nbox = [[2.25, 0.75, -1], [2.5, 1, -1]]\n")) ==
        std::vector<int>{5, 6, 9, 10});
  CHECK(held(sheet_with("[[hold]]\nbox = [[2.26, 0.75, -2], [2.74, 1.24, 0]]\n")) ==
        std::vector<int>{6, 10});
  // so has the top: rows lie at 0, 1/4, ..., 1 of the height
  CHECK(held(sheet_with("[[hold]]\ntop = 0.25\n")) ==
        std::vector<int>{12, 13, 14, 15, 16, 17, 18, 19});
  CHECK(held(sheet_with("[[hold]]\ntop = 0.2499\n")) == std::vector<int>{16, 17, 18, 19});
  CHECK(held(sheet_with("[[hold]]\ntop = 1\n")).size() == 20);
}

TEST_CASE("holds add up, each with its motion from the start's places", "[scene]") {
  const Scene scene = sheet_with(
      "[[hold]]\nparticles = [3]\nvelocity = [0.1, 0.2, 0.4]\n[[hold]]\nparticles = [5, 4]\n"
      "from = 0.125\n[start]\nstretch = 2\n");
  REQUIRE(held(scene) == std::vector<int>{3, 5, 4});
  CHECK(scene.warnings.empty());
  CHECK(scene.prescribed[0].motion.velocity == Vector3(0.1, 0.2, 0.4));
  CHECK(scene.prescribed[0].motion.from == 0);
  CHECK(scene.prescribed[1].motion.velocity == Vector3::Zero());
  CHECK(scene.prescribed[1].motion.from == 0.125);
  CHECK(scene.prescribed[2].motion.from == 0.125);
  for (const PrescribedParticle& p : scene.prescribed) CHECK(p.start == scene.x.col(p.particle));
}

TEST_CASE("a hold needs one selection, that exists and selects, and holds nothing twice",
          "[scene]") {
  const std::string one = "some.toml:10: [[hold]] needs one of 'particles', 'box', 'top'";
  const std::string box = "box = [[0, 0, 0], [1, 1, 1]]\n";
  CHECK(refusal("[[hold]]\n") == one);
  CHECK(refusal("[[hold]]\nparticles = [0]\ntop = 0.5\n") == one);
  CHECK(refusal("[[hold]]\nparticles = [0]\n" + box) == one);
  CHECK(refusal("[[hold]]\ntop = 0.5\n" + box) == one);
  CHECK(refusal("[[hold]]\nparticles = [19]\n") == "none");
  CHECK(refusal("[[hold]]\nparticles = [20]\n") ==
        "some.toml:11: particle 20 does not exist; there are 20");
  CHECK(refusal("[[hold]]\nparticles = [-1]\n") ==
        "some.toml:11: particle -1 does not exist; there are 20");
  CHECK(refusal("[[hold]]\ntop = 0\n") == "some.toml:11: 'top' must be > 0");
  CHECK(refusal("[[hold]]\nparticles = [7, 7]\n") == "some.toml:10: particle 7 is held twice");
  CHECK(refusal("[[hold]]\nparticles = [7]\n[[hold]]\nparticles = [3, 7]\n") ==
        "some.toml:12: particle 7 is held twice");
  const std::string extent = "; the cloth lies from (2, 0.5, -1) to (2.75, 1.5, -1) m";
  CHECK(refusal("[[hold]]\n" + box) == "some.toml:11: [[hold]] holds no particle" + extent);
  CHECK(refusal("[[hold]]\nparticles = []\n") ==
        "some.toml:11: [[hold]] holds no particle" + extent);
  CHECK(refusal("[[hold]]\nbox = [[0, 0, 0]]\n") ==
        "some.toml:11: 'box' must be two points [[x, y, z], [x, y, z]], lowest and highest");
  CHECK(refusal("[[hold]]\nbox = [[0, 0, 0], [1, 1, 1], [2, 2, 2]]\n") ==
        "some.toml:11: 'box' must be two points [[x, y, z], [x, y, z]], lowest and highest");
}

TEST_CASE("a box that holds one particle is pointed out, a list of one is not", "[scene]") {
  CHECK(sheet_with("[[hold]]\nbox = [[2, 0.5, -1], [2.1, 0.6, -1]]\n").warnings ==
        std::vector<std::string>{"some.toml:11: [[hold]] holds one particle only, number 0; the "
                                 "cloth lies from (2, 0.5, -1) to (2.75, 1.5, -1) m"});
  CHECK(sheet_with("[[hold]]\nbox = [[2, 0.5, -1], [2.3, 0.6, -1]]\n").warnings.empty());
  CHECK(sheet_with("[[hold]]\nparticles = [5]\n").warnings.empty());
  // of a cloth whose highest particle is alone
  const Scene hinge = scene_with("[[hold]]\ntop = 0.01\n");
  CHECK(held(hinge) == std::vector<int>{0});
  REQUIRE(hinge.warnings.size() == 1);
  CHECK_THAT(hinge.warnings[0],
             StartsWith("some.toml:7: [[hold]] holds one particle only, number 0; the cloth"));
}

TEST_CASE("a case's name has plain letters, digits and '_', '-', '.', 100 at most", "[scene]") {
  for (const std::string name :
       {"a", "z", "A", "Z", "0", "9", "_", "q-", "q.x", "azAZ09_-.b", "q."})
    CHECK(said_of(name + ".toml") == name);
  CHECK(said_of(std::string(100, 'm') + ".toml") == std::string(100, 'm'));
  for (const std::string name :
       {"`", "{", "@", "[", "/:", "a b", "\xC3\xA9", ".a", "-a", "a..b", "a,", "", "a:"}) {
    INFO(name);
    CHECK(said_of(name + ".toml") ==
          name +
              ".toml: a case is named after its file, by at most 100 letters a-z, digits and '_', "
              "'-', '.', the first no hyphen or dot and no two dots in a row; rename the file");
  }
  CHECK_THAT(said_of(std::string(101, 'm') + ".toml"),
             Contains(": a case is named after its file"));
}

TEST_CASE("a case file's folder, texts and overrides are kept", "[scene]") {
  const ScratchFolder folder;
  const std::string text = "title = \"T\"\nabout = \"A\"\n" + hinge_cloth + "[time]\nend = 1\n";
  const std::string path = folder.write("q.toml", text);
  const Scene scene = read_scene(path, {"time.end=2", "cloth.density=3"});
  CHECK(scene.name == "q");
  CHECK(scene.title == "T");
  CHECK(scene.about == "A");
  CHECK(scene.folder + "/q.toml" == path);
  CHECK(scene.text == text + "\n# --set time.end=2\n# --set cloth.density=3");
  CHECK(scene.density == 3);
  CHECK(scene.schedule.end == 2);
  const std::string absent = folder.file("absent.toml");
  CHECK_THROWS_WITH(read_scene(absent), absent + ": there is no such case file");
  CHECK_THROWS_WITH(read_scene(folder.file(".")), Contains("there is no such case file"));
}

TEST_CASE("tables for others are left, and unknown ones refused", "[scene]") {
  CHECK_NOTHROW(scene_with("[expect.a]\nb = 1\n[ablation]\nc = 2\n[[quantity]]\nd = 3\n"));
  CHECK_THROWS_WITH(scene_with("[nothing]\n"),
                    StartsWith("some.toml:6: unknown key 'nothing' in the file; known here: "));
  CHECK_THROWS_WITH(scene_with("[stretch]\nstiffness = 3\nwidth = 3\n"),
                    StartsWith("some.toml:8: unknown key 'width' in [stretch]; known here: "));
  CHECK_NOTHROW(
      scene_from(parse_case_text(hinge_cloth + "[nothing]\n[time]\nend = 1\n", "some.toml", {})));
}

TEST_CASE("a density must be positive, and masses must be finite", "[scene]") {
  const auto cloth = [](const std::string& density) {
    return read_scene_text("[cloth]\nshape = \"hinge\"\nlength = 3\nangle = 9\ndensity = " +
                               density + "\n[time]\nend = 1\n",
                           "some.toml");
  };
  CHECK_THROWS_WITH(cloth("0"), "some.toml:5: 'density' must be > 0");
  CHECK_NOTHROW(cloth("1e300"));
  CHECK_THROWS_WITH(cloth("1.7e308"),
                    "some.toml:1: a particle has the mass 0, or one that is not finite");
}

TEST_CASE("a start must be finite, with the velocities of its holds", "[scene]") {
  const std::string not_finite =
      "some.toml:1: a place or velocity at the start, or at rest, is not finite";
  CHECK(refusal("[start]\nstretch = [1, 1.7e308, 1]\n") == "none");
  CHECK(refusal("[start]\nstretch = [1, 1.7e308, 1]\nvelocity = [1, 1.7e308, 2]\n") == "none");
  CHECK(refusal("[start]\nvelocity = [1.7e308, 2, 3]\nspin = [0, 0, 1.7e308]\n") == "none");
  CHECK(refusal("[start]\nspin = [0, 0, 1.7e308]\nstretch = [1, 1e3, 1]\n") == not_finite);
  // before anything else is made of it
  CHECK(refusal("[start]\nspin = [0, 0, 1.7e308]\nstretch = [1, 1e3, 1]\n[[hold]]\n"
                "box = [[0, 0, 0], [1, 1, 1]]\n") == not_finite);
  CHECK(refusal("[[hold]]\nparticles = [0]\namplitude = [1.7e308, 0, 0]\nfrequency = 3\n") ==
        not_finite);
}

TEST_CASE("a cloth is refined if that makes no more triangles than the limit", "[scene]") {
  CHECK(scene_of_cloth("shape = \"hinge\"\nlength = 1\nangle = 9\nrefine = 2\n", {32, 3})
            .mesh.triangles.size() == 32);
  CHECK_THROWS_WITH(
      scene_of_cloth("shape = \"hinge\"\nlength = 1\nangle = 9\nrefine = 2\n", {31, 3}),
      "some.toml:6: 'refine' asks for 32 triangles; 31 at most are made");
  CHECK(
      scene_of_cloth("shape = \"hinge\"\nlength = 1\nangle = 9\n", {2, 3}).mesh.triangles.size() ==
      2);
}
