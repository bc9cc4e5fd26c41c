// A case as a whole: its tables, holds, name, sizes, overflow, and keys for others.
#include <catch2/catch.hpp>

#include "verification/tests/reference/scene/scene_texts.h"

using namespace foldproof;
using Catch::Matchers::Contains;

namespace {

std::vector<int> held(const std::string& hold) {
  std::vector<int> particles;
  for (const PrescribedParticle& p : sheet_with("[[hold]]\n" + hold + "\n").prescribed)
    particles.push_back(p.particle);
  return particles;
}

/// The name of the case that a file of this name holds.
std::string name_of(const std::string& file) {
  return read_scene_text(hinge_cloth + "[time]\nend = 1\n", file).name;
}

}  // namespace

TEST_CASE("a hold's particles are those listed, in a box, or near the top", "[scene]") {
  using Held = std::vector<int>;
  CHECK(held("particles = [7, 0, 19]") == Held{7, 0, 19});
  // a box has its border
  CHECK(held("box = [[2.25, 0.75, -1], [2.5, 1, -1]]") == Held{5, 6, 9, 10});
  CHECK(held("box = [[2.26, 0.75, -2], [2.74, 1.24, 0]]") == Held{6, 10});
  // so has the top: rows lie at 0, 1/4, ..., 1 of the height
  CHECK(held("top = 0.25") == Held{12, 13, 14, 15, 16, 17, 18, 19});
  CHECK(held("top = 0.2499") == Held{16, 17, 18, 19});
  CHECK(held("top = 1").size() == 20);
  const Scene scene = sheet_with(
      "[[hold]]\nparticles = [3]\nvelocity = [0.1, 0.2, 0.4]\n[[hold]]\nparticles = [5, 4]\n"
      "from = 0.125\n[start]\nstretch = 2\n");
  REQUIRE(scene.prescribed.size() == 3);
  CHECK(scene.prescribed[0].motion.from == 0);
  CHECK(scene.prescribed[1].motion.velocity == Vector3::Zero());
  CHECK(scene.prescribed[2].motion.from == 0.125);
  for (const PrescribedParticle& p : scene.prescribed) CHECK(p.start == scene.x.col(p.particle));
}

TEST_CASE("a hold needs one selection, that exists and selects, and holds nothing twice",
          "[scene]") {
  const std::string one = "some.toml:10: [[hold]] needs one of 'particles', 'box', 'top'",
                    box = "box = [[0, 0, 0], [1, 1, 1]]";
  check_refused(
      held,
      {{"", one},
       {"particles = [0]\ntop = 0.5", one},
       {"particles = [0]\n" + box, one},
       {"top = 0.5\n" + box, one},
       {"particles = [20]", "some.toml:11: particle 20 does not exist; there are 20"},
       {"particles = [7, 7]", "some.toml:10: particle 7 is held twice"},
       {"particles = [7]\n[[hold]]\nparticles = [3, 7]", "some.toml:12: particle 7 is held"},
       {"particles = []", "some.toml:11: [[hold]] holds no particle"},
       {box, "holds no particle; the cloth lies from (2, 0.5, -1) to (2.75, 1.5, -1) m"},
       {"box = [[0, 0, 0], [1, 1, 1], [2, 2, 2]]", "some.toml:11: 'box' must be two points"}});
}

TEST_CASE("a case's name has plain letters, digits and '_', '-', '.', 100 at most", "[scene]") {
  for (const std::string& name : {std::string("a"), std::string("azAZ09_-.b"), std::string("q."),
                                  std::string("_"), std::string(100, 'm')})
    CHECK(name_of(name + ".toml") == name);
  for (const std::string& name :
       {std::string("`"), std::string("{"), std::string("@"), std::string("["), std::string("/:"),
        std::string("\xC3\xA9"), std::string(".a"), std::string("-a"), std::string("a..b"),
        std::string(), std::string(101, 'm')})
    check_refused(name_of, {{name + ".toml", name + ".toml: a case is named after its file"}});
}

TEST_CASE("masses and the start must be finite, with the velocities of its holds", "[scene]") {
  const auto dense = [](const std::string& density) {
    return read_scene_text("[cloth]\nshape = \"hinge\"\nlength = 3\nangle = 9\ndensity = " +
                               density + "\n[time]\nend = 1\n",
                           "some.toml");
  };
  CHECK_NOTHROW(dense("1e300"));
  CHECK_THROWS_WITH(dense("1.7e308"), Contains("some.toml:1: a particle has the mass 0"));
  const std::string not_finite = "some.toml:1: a place or velocity at the start",
                    spins = "[start]\nspin = [0, 0, 1.7e308]\n";
  CHECK_NOTHROW(sheet_with("[start]\nstretch = [1, 1.7e308, 1]\nvelocity = [1, 1.7e308, 2]\n"));
  CHECK_NOTHROW(sheet_with(spins + "velocity = [1.7e308, 2, 3]\n"));
  check_refused(
      sheet_with,
      {{spins + "stretch = [1, 1e3, 1]\n", not_finite},
       // before anything else is made of it
       {spins + "stretch = [1, 1e3, 1]\n[[hold]]\nbox = [[0, 0, 0], [1, 1, 1]]\n", not_finite},
       {"[[hold]]\nparticles = [0]\namplitude = [1.7e308, 0, 0]\nfrequency = 3\n", not_finite}});
}
