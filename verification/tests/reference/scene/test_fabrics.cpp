// Measured fabrics: their file, and what they ask of a mesh.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "reference/mesh/rigidity_map.h"
#include "reference/mesh/shapes.h"
#include "reference/scene/fabrics.h"
#include "verification/specimens/scratch_folder.h"
#include "verification/tests/reference/scene/scene_texts.h"

using namespace foldproof;
using Catch::Matchers::EndsWith;
using Catch::Matchers::StartsWith;

namespace {

/// A fabric but for its rigidity, 8 lines.
std::string fabric(const std::string& name, const std::string& more) {
  return "[[fabric]]\nname = \"" + name +
         "\"\nwords = \"w\"\nsource = \"s\"\nplace = \"p\"\nmethod = \"m\"\ndensity = 0.35\n"
         "missing = [\"u\", \"v\"]\n" +
         more;
}

const std::string rigid = "rigidity = { first = 3e-6, second = 4.5e-6 }\n";

std::string refusal(const std::string& text) {
  const ScratchFolder folder;
  const std::string path = folder.write("fabrics.toml", text);
  try {
    read_fabrics(path);
  } catch (const InputError& error) {
    const std::string said = error.what();
    return said.starts_with(path + ":") ? said.substr(path.size() + 1) : "elsewhere: " + said;
  }
  return "none";
}

std::vector<Fabric> fabrics(const std::string& text) {
  const ScratchFolder folder;
  return read_fabrics(folder.write("fabrics.toml", text));
}

std::string printed(const char* format, double a, double b, double c) {
  char text[300];
  std::snprintf(text, sizeof text, format, a, b, c);
  return text;
}

}  // namespace

TEST_CASE("a fabric takes each key of its table", "[scene]") {
  const std::vector<Fabric> read =
      fabrics(fabric("denim", rigid + "scatter = 0.15\n") +
              fabric("rib", "hinge_stiffness = { first = 8e-6, second = 2e-6 }\n"));
  REQUIRE(read.size() == 2);
  CHECK(read[0].name == "denim");
  CHECK(read[0].words == "w");
  CHECK(read[0].source == "s");
  CHECK(read[0].place == "p");
  CHECK(read[0].method == "m");
  CHECK(read[0].density == 0.35);
  CHECK(read[0].rigidity == std::array<double, 2>{3e-6, 4.5e-6});
  CHECK(read[0].scatter == 0.15);
  CHECK(read[0].missing == std::vector<std::string>{"u", "v"});
  // a quarter of a hinge's stiffness
  CHECK(read[1].rigidity == std::array<double, 2>{2e-6, 0.5e-6});
  CHECK(std::isnan(read[1].scatter));
}

TEST_CASE("a fabric that lacks something, or has it twice, is refused with its place", "[scene]") {
  CHECK(refusal(fabric("", rigid)) == "2: 'name' is empty");
  const std::string one = ": a fabric has one of 'rigidity' and 'hinge_stiffness'";
  CHECK(refusal(fabric("a", "")) == "1" + one);
  CHECK(refusal(fabric("a", rigid + "hinge_stiffness = { first = 1, second = 1 }\n")) == "9" + one);
  CHECK(refusal(fabric("a", rigid + "scatter = 0\n")) == "10: 'scatter' must be > 0");
  CHECK(refusal(fabric("a", "rigidity = { first = 0, second = 1 }\n")) == "9: 'first' must be > 0");
  CHECK(refusal(fabric("a", "rigidity = { first = 1, second = 0 }\n")) ==
        "9: 'second' must be > 0");
  CHECK(refusal(fabric("a", rigid) + fabric("b", rigid) + fabric("a", rigid)) ==
        "20: the fabric 'a' is there already");
  CHECK_THAT(refusal(fabric("a", rigid + "extra = 1\n")),
             StartsWith("10: unknown key 'extra' in [fabric]; known here: "));
  CHECK_THAT(refusal("[other]\n"), EndsWith("there is no [[fabric]]"));
  CHECK_THAT(refusal(fabric("a", rigid) + "[other]\n"), StartsWith("10: unknown key 'other'"));
}

TEST_CASE("a fabric is found by its name, or refused with the known ones", "[scene]") {
  const std::vector<Fabric> read = fabrics(fabric("a", rigid) + fabric("b", rigid));
  CHECK(&fabric_named(read, "b", "w") == &read[1]);
  CHECK_THROWS_WITH(fabric_named(read, "c", "some.toml:3"),
                    "some.toml:3: unknown fabric 'c'; known: a, b");
}

TEST_CASE("on a flat mesh the stiffness is the rigidity over that of a strip along x", "[scene]") {
  const Fabric denim = fabrics(fabric("denim", rigid))[0];
  const TriangleMesh mesh = make_sheet({SheetPattern::one_diagonal, 0.7, 0.9, 5, 8, 0, 1, 1.5});
  const FabricOnMesh on = fabric_on_mesh(denim, mesh);
  RestPlane plane;
  REQUIRE(is_flat(mesh, plane));
  const Rigidity rigidity = rigidity_of(mesh, plane);
  const double along = rigidity.of_strip(0), across = rigidity.of_strip(std::numbers::pi / 2);
  CHECK(on.rigidity_ratio == along);
  CHECK(on.stiffness == Approx(3e-6 / along).epsilon(1e-14));
  CHECK(on.second_over_first == Approx(across / along).epsilon(1e-14));
  CHECK(std::abs(across / along - 1) > 0.01);
  const double anisotropy = extremes_of(rigidity).greatest / extremes_of(rigidity).least;
  CHECK(on.anisotropy == Approx(anisotropy).epsilon(1e-14));
  CHECK(on.report ==
        printed("Fabric 'denim': B = 3e-06 N m along its first direction and B/ke = %.4g of a "
                "strip of this mesh give ke = %.4g J. Along the second direction the fabric is 1.5 "
                "times as stiff, this mesh %.3g times; its stiffest direction is ",
                along, 3e-6 / along, across / along) +
            printed("%.3g times its softest.", anisotropy, 0, 0));
}

TEST_CASE("on a curved mesh the stiffness follows from the median over its particles", "[scene]") {
  const Fabric denim = fabrics(fabric("denim", rigid))[0];
  // some corners of the pleated sheet have too few hinges
  TriangleMesh pleated = make_sheet({SheetPattern::one_diagonal, 0.7, 0.9, 4, 5, 0, 1, 1});
  pleated.rest = pleated_positions(pleated, 2, 0.3);
  CHECK(std::isnan(rigidity_around_particles(pleated)[4].least));
  for (const TriangleMesh& mesh : {make_cylinder(0.3, 0.9, 7, 4), make_cylinder(0.3, 0.9, 7, 5),
                                   make_icosphere(0.3, 2), pleated}) {
    std::vector<double> means;
    double anisotropy = 0;
    for (const RigidityExtremes& at : rigidity_around_particles(mesh)) {
      if (std::isnan(at.least)) continue;
      means.push_back((at.least + at.greatest) / 2);
      anisotropy = std::max(anisotropy, at.greatest / at.least);
    }
    std::sort(means.begin(), means.end());
    const double median = means[means.size() / 2];
    const FabricOnMesh on = fabric_on_mesh(denim, mesh);
    CHECK(on.rigidity_ratio == Approx(median).epsilon(1e-12));
    CHECK(on.stiffness == Approx(3e-6 / median).epsilon(1e-12));
    CHECK(on.anisotropy == Approx(anisotropy).epsilon(1e-12));
    CHECK(std::isnan(on.second_over_first));
    CHECK(on.report ==
          printed("Fabric 'denim': B = 3e-06 N m along its first direction and B/ke = %.4g of a "
                  "strip of this mesh give ke = %.4g J. Along the second direction the fabric is "
                  "1.5 times as stiff; the mesh is not flat, and around single particles its "
                  "stiffest direction is up to %.3g times its softest.",
                  median, 3e-6 / median, anisotropy));
  }
}

TEST_CASE("a mesh of a single hinge is no cloth to bend", "[scene]") {
  const Fabric denim = fabrics(fabric("denim", rigid))[0];
  const std::string few = "fabric 'denim': the cloth has too few hinges to bend";
  CHECK_THROWS_WITH(fabric_on_mesh(denim, make_hinge(1, 0)), few);
  CHECK_THROWS_WITH(fabric_on_mesh(denim, make_hinge(1, 0.5)), few);
}

TEST_CASE("a case takes density and stiffness from its fabric, unless it has its own", "[scene]") {
  const ScratchFolder folder;
  folder.write("fabrics.toml", fabric("denim", rigid));
  const std::string other =
      folder.write("other.toml", fabric("denim", "rigidity = { first = 6e-6, second = 1 }\n"));
  const std::string sheet =
      "[cloth]\nshape = \"sheet\"\nwidth = 0.7\nheight = 0.9\ncolumns = 5\nrows = 8\n";
  const auto read = [&](const std::string& keys, const std::string& bending,
                        const std::string& about = "") {
    return read_scene_text(about + sheet + keys + "[time]\nend = 1\n[bending]\n" + bending,
                           folder.file("some.toml"));
  };
  const Fabric denim = fabrics(fabric("denim", rigid))[0];
  const Scene scene = read("fabric = \"denim\"\n", "");
  const FabricOnMesh on = fabric_on_mesh(denim, scene.mesh);
  CHECK(scene.density == 0.35);
  CHECK(scene.bending->stiffness == on.stiffness);
  CHECK(scene.about == on.report);
  CHECK(read("fabric = \"denim\"\n", "", "about = \"A.\"\n").about == "A. " + on.report);
  CHECK(read("fabric = \"denim\"\ndensity = 0.5\n", "").density == 0.5);
  CHECK(read("fabric = \"denim\"\n", "stiffness = 0.25\n").bending->stiffness == 0.25);
  CHECK(read("fabric = \"denim\"\nfabrics = \"other.toml\"\n", "").bending->stiffness ==
        Approx(2 * on.stiffness).epsilon(1e-14));
  CHECK(read("fabric = \"denim\"\nfabrics = \"" + other + "\"\n", "").bending->stiffness ==
        Approx(2 * on.stiffness).epsilon(1e-14));
  CHECK_THROWS_WITH(read("density = 1\nfabrics = \"other.toml\"\n", "stiffness = 1\n"),
                    EndsWith(":8: 'fabrics' is a file to look 'fabric' up in; name one"));
  CHECK_THROWS_WITH(read("fabric = \"silk\"\n", ""),
                    EndsWith(":7: unknown fabric 'silk'; known: denim"));
  CHECK_THROWS_WITH(read("density = 1\n", ""), EndsWith(": [bending] needs the key 'stiffness'"));
}
