// Measured fabrics: their file, and what they ask of a mesh.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "reference/mesh/rigidity_map.h"
#include "reference/mesh/shapes.h"
#include "reference/scene/fabrics.h"
#include "verification/specimens/scratch_folder.h"
#include "verification/tests/reference/scene/scene_texts.h"

using namespace foldproof;
using Catch::Matchers::Contains;

namespace {

/// A fabric but for its rigidity, 8 lines.
std::string fabric(const std::string& name, const std::string& more) {
  return "[[fabric]]\nname = \"" + name +
         "\"\nwords = \"w\"\nsource = \"s\"\nplace = \"p\"\nmethod = \"m\"\ndensity = 0.35\n"
         "missing = [\"u\", \"v\"]\n" +
         more;
}

const std::string rigid = "rigidity = { first = 3e-6, second = 4.5e-6 }\n";

std::vector<Fabric> fabrics(const std::string& text) {
  const ScratchFolder folder;
  return read_fabrics(folder.write("fabrics.toml", text));
}

}  // namespace

TEST_CASE("a fabric has its rigidity, or a quarter of a hinge's stiffness", "[scene]") {
  const std::vector<Fabric> read =
      fabrics(fabric("denim", rigid + "scatter = 0.15\n") +
              fabric("rib", "hinge_stiffness = { first = 8e-6, second = 2e-6 }\n"));
  REQUIRE(read.size() == 2);
  CHECK(read[0].density == 0.35);
  CHECK(read[0].rigidity == std::array<double, 2>{3e-6, 4.5e-6});
  CHECK(read[0].scatter == 0.15);
  CHECK(read[1].rigidity == std::array<double, 2>{2e-6, 0.5e-6});
  CHECK(std::isnan(read[1].scatter));
  CHECK(&fabric_named(read, "rib", "some.toml:3") == &read[1]);
  CHECK_THROWS_WITH(fabric_named(read, "c", "some.toml:3"),
                    "some.toml:3: unknown fabric 'c'; known: denim, rib");
}

TEST_CASE("a fabric that lacks something, or has it twice, is refused with its place", "[scene]") {
  const std::string one = ": a fabric has one of 'rigidity' and 'hinge_stiffness'";
  check_refused(
      fabrics,
      {{fabric("", rigid), ":2: 'name' is empty"},
       {fabric("a", ""), ":1" + one},
       {fabric("a", rigid + "hinge_stiffness = { first = 1, second = 1 }\n"), ":9" + one},
       {fabric("a", "rigidity = { first = 1, second = 0 }\n"), ":9: 'second' must be > 0"},
       {fabric("a", rigid) + fabric("b", rigid) + fabric("a", rigid), ":20: the fabric 'a' is"},
       {fabric("a", rigid) + "[other]\n", ":10: unknown key 'other'"}});
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
  }
}

TEST_CASE("a case takes density and stiffness from its fabric, unless it has its own", "[scene]") {
  const ScratchFolder folder;
  folder.write("fabrics.toml", fabric("denim", rigid));
  const std::string other =
      folder.write("other.toml", fabric("denim", "rigidity = { first = 6e-6, second = 1 }\n"));
  const auto read = [&](const std::string& keys, const std::string& bending = "") {
    return read_scene_text(
        "about = \"A.\"\n[cloth]\nshape = \"sheet\"\nwidth = 0.7\nheight = 0.9\ncolumns = 5\n"
        "rows = 8\n" +
            keys + "[time]\nend = 1\n[bending]\n" + bending,
        folder.file("some.toml"));
  };
  const std::string denim = "fabric = \"denim\"\n";
  const Scene scene = read(denim);
  const FabricOnMesh on = fabric_on_mesh(fabrics(fabric("denim", rigid))[0], scene.mesh);
  CHECK(scene.density == 0.35);
  CHECK(scene.bending->stiffness == on.stiffness);
  CHECK(scene.about == "A. " + on.report);
  CHECK(read(denim + "density = 0.5\n").density == 0.5);
  CHECK(read(denim, "stiffness = 0.25\n").bending->stiffness == 0.25);
  for (const std::string& file : {std::string("other.toml"), other})
    CHECK(read(denim + "fabrics = \"" + file + "\"\n").bending->stiffness ==
          Approx(2 * on.stiffness).epsilon(1e-14));
  check_refused(read, {{"density = 1\nfabrics = \"other.toml\"\n", ":9: 'fabrics' is a file"},
                       {"fabric = \"silk\"\n", ":8: unknown fabric 'silk'; known: denim"},
                       {"density = 1\n", ": [bending] needs the key 'stiffness'"}});
}
