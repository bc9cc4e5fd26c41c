// Sizes of a scene, and what they betray: other units, open seams, steps that are too long.
#include <catch2/catch.hpp>

#include "reference/scene/scene_sizes.h"
#include "verification/specimens/check.h"
#include "verification/specimens/scratch_folder.h"

using namespace foldproof;
using Catch::Matchers::Contains;

namespace {

const std::string square = "v 0 0 0\nv 100 0 0\nv 100 100 0\nv 0 100 0\nf 1 2 3 4\n";
const std::string halves =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 4 5 6\n";
const std::string gaping =
    "v 0 0 0\nv 20 0 0\nv 20 20 0\nv -3e-3 4e-3 0\nv 20 20.005 0\nv 0 20 0\nf 1 2 3\nf 4 5 6\n";
const std::string body = "v 0 0 5\nv 2 0 5\nv 0 2 5\nv 0 0 7\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";

/// All warnings of a cloth with these keys, one behind the other.
std::string warnings_of(const std::string& mesh, const std::string& keys,
                        const std::string& more = "") {
  const ScratchFolder folder;
  folder.write("cloth.obj", mesh);
  folder.write("body.obj", body);
  const Scene scene =
      read_scene_text("[cloth]\nmesh = \"cloth.obj\"\n" + keys + "\n" + more + "[time]\nend = 1\n",
                      folder.file("some.toml"));
  std::string all;
  for (const std::string& warning : scene.warnings) all += warning + "\n";
  return all;
}

}  // namespace

TEST_CASE("a cloth in centimetres, its density in grams, and a body in metres are warned of") {
  CHECK(warnings_of(square, "density = 0.2\nscale = 0.01") == "");
  CHECK_THAT(warnings_of(square, "density = 0.2"),
             Contains("some.toml:2: the cloth is 100 m long") && Contains("scale = 0.01"));
  CHECK_THAT(warnings_of(square, "density = 200\nscale = 0.01"),
             Contains("some.toml:3: a density of 200 kg/m^2") && Contains("200 g/m^2 are 0.2"));
  CHECK_THAT(warnings_of(square, "density = 0.002\nscale = 0.01"), Contains("density of 0.002"));
  const std::string object = "[[object]]\nmesh = \"body.obj\"\n";
  CHECK(warnings_of(square, "density = 0.2\nscale = 0.01", object) == "");
  CHECK_THAT(
      warnings_of(square, "density = 0.2\nscale = 0.15", object),
      Contains("the cloth is 15 m long and object 'mesh 1' 2 m") && Contains("scale = 0.1 "));
  CHECK_THAT(warnings_of(square, "density = 0.2\nscale = 0.01", object + "scale = 1000\n"),
             Contains("object 'mesh 1' 2e+03 m") && Contains("[[object]] scale = 0.001"));
  CHECK_THAT(rejection_message([] { warnings_of(square, "density = 1\nscale = 2\nfit = 1"); }),
             Contains("'fit' and 'scale' both set the size"));
}

TEST_CASE("vertices of a border that coincide are counted, with the key that sews them") {
  CHECK_THAT(warnings_of(halves, "density = 0.2"),
             Contains("at 2 places vertices coincide") && Contains("seams = 1e-06"));
  CHECK(warnings_of(halves, "density = 0.2\nseams = 1e-6") == "");
  CHECK_THAT(warnings_of(gaping, "density = 0.2\nscale = 0.01"),
             Contains("at 2 places vertices of the border are 0.005 or less apart") &&
                 Contains("seams = 0.006 of [cloth]"));
  CHECK(warnings_of(gaping, "density = 0.2\nscale = 0.01\nseams = 0.006") == "");
}

TEST_CASE("sizes are told, and a fixed step beyond the elastic limit") {
  const auto scene = [](const std::string& time) {
    return read_scene_text(
        "[cloth]\nshape = \"sheet\"\nwidth = 1\nheight = 0.5\ncolumns = 4\nrows = 2\n"
        "density = 0.2\n[stretch]\nstiffness = 100\n[time]\nend = 1\n" +
            time,
        "some.toml");
  };
  const auto warning = [&](const std::string& time) {
    const Scene of = scene(time);
    return warning_of_step(of, build_system(of), start_state(of));
  };
  CHECK(sizes_in_words(scene("")) == "cloth 1 x 0.5 x 0 m, 0.5 m^2, 0.1 kg");
  CHECK(warning("") == "");
  CHECK(warning("step = 1e-3\n") == "");
  CHECK(warning("step = 0.1\nintegrator = \"backward-euler\"\n") == "");
  CHECK_THAT(warning("step = 0.1\n"), Contains("a step of 0.1 s is") && Contains("below which C"));
}

TEST_CASE("a start that crosses itself, or lies flat on itself, is warned of") {
  const auto said = [](const std::string& copy, const std::string& more = "") {
    const Scene scene = read_scene_text(
        "[cloth]\nshape = \"sheet\"\nwidth = 1.1\nheight = 0.7\ncolumns = 11\nrows = 7\n"
        "density = 0.2\nturn = { axis = [1, 0, 0], angle = 30 }\ncopies = { count = 2, " +
            copy + " }\n" + more + "[time]\nend = 1\n",
        "some.toml");
    return warning_of_start(scene, start_state(scene));
  };
  const std::string crossed = "move = [0.3, 0, 0], turn = { axis = [0, 1, 0], angle = 70 }";
  CHECK(said("move = [1.3, 0, 0]") == "");  // beside it in one plane
  CHECK(said("move = [0.3, 0, 0.2]") == "");
  CHECK_THAT(said("move = [0.3, 0, 0]"), Contains("the cloth lies on itself at the start, in"));
  CHECK_THAT(said(crossed), Contains("the cloth crosses itself at the start, in"));
  CHECK(said(crossed, "[self_collision]\nthickness = 0.01\n") == "");
}
