// Rigidity of meshes by direction, and measured fabrics on them.
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <numbers>

#include "reference/mesh/rigidity_map.h"
#include "reference/mesh/shapes.h"
#include "reference/scene/fabrics.h"
#include "reference/types.h"
#include "verification/oracles/homogenised_bending.h"
#include "verification/specimens/scratch_folder.h"

using namespace foldproof;
using Catch::Matchers::Contains;

namespace {

constexpr double degree = std::numbers::pi / 180;

/// D/ke of a large sheet of squares, cells of 1 cm.
Rigidity of_squares(SheetPattern pattern, int cells) {
  const TriangleMesh mesh = make_sheet({pattern, 0.01 * cells, 0.01 * cells, cells, cells});
  RestPlane plane;
  REQUIRE(is_flat(mesh, plane));
  return rigidity_of(mesh, plane);
}

constexpr const char* one_fabric = R"([[fabric]]
name = "felt"
words = "pressed felt"
density = 0.3
rigidity = { first = 8e-6, second = 6e-6 }
source = "a book"
place = "table 3"
method = "cantilever"
missing = ["friction"]
)";

std::vector<Fabric> fabrics_in(const std::string& text) {
  const ScratchFolder folder;
  std::ofstream(folder.file("f.toml")) << text;
  return read_fabrics(folder.file("f.toml"));
}

std::string with(std::string text, const std::string& part, const std::string& other) {
  const size_t at = text.find(part);
  REQUIRE(at != std::string::npos);
  return text.replace(at, part.size(), other);
}

}  // namespace

TEST_CASE("a large sheet has the rigidity of its homogenised cell, in every direction") {
  const auto rising = [](int, int) { return true; };
  const Eigen::Matrix3d cell =
      oracles::forced_rigidity(oracles::split_rectangles({1, 1, 1, 1, rising}));
  const Rigidity sheet = of_squares(SheetPattern::one_diagonal, 60);
  for (const double angle : {0.0, 30.0, 45.0, 90.0, 135.0}) {
    INFO(angle);
    CHECK(sheet.along(angle * degree) ==
          Approx(oracles::cylinder_rigidity(cell, angle * degree)).epsilon(0.03));
  }
  CHECK(sheet.along(45 * degree) == Approx(0.75).epsilon(0.03));
  const RigidityExtremes extremes = extremes_of(sheet);
  CHECK(extremes.greatest_angle == Approx(45 * degree).margin(2 * degree));
  CHECK(extremes.anisotropy() == Approx(4).epsilon(0.03));  // 3/4 over 3/16
  for (const double angle : {0.0, 20.0, 90.0})
    CHECK(sheet.of_strip(angle * degree) ==
          Approx(oracles::strip_rigidity(cell, angle * degree)).epsilon(0.03));
}

TEST_CASE(
    "around a particle inside, rigidity is that of the pattern; equilateral ones are isotropic") {
  const TriangleMesh mesh = make_sheet({SheetPattern::equilateral, 0.12, 0, 12, 12});
  double largest = 0;
  int inside = 0;
  const std::vector<RigidityExtremes> around = rigidity_around_particles(mesh);
  for (int i = 0; i < mesh.particles(); ++i) {
    const Vector3 x = mesh.rest.col(i);
    if (x.x() < 0.025 || x.x() > 0.095 || x.y() < 0.025 || x.y() > 0.075) continue;
    ++inside;
    largest = std::max(largest, around[size_t(i)].anisotropy());
    CHECK(around[size_t(i)].least == Approx(0.25).epsilon(1e-9));
  }
  CHECK(inside > 10);
  CHECK(largest == Approx(1).epsilon(1e-9));
}

TEST_CASE("a curved rest shape is not flat, a turned one is") {
  RestPlane plane;
  CHECK(!is_flat(make_cylinder(0.1, 0.3, 20, 5), plane));
  TriangleMesh sheet = make_sheet({SheetPattern::alternating, 0.1, 0.1, 4, 4});
  const Rigidity before = [&] {
    REQUIRE(is_flat(sheet, plane));
    return rigidity_of(sheet, plane);
  }();
  sheet.rest = (Eigen::AngleAxisd(0.5, Vector3::UnitX()).matrix() * sheet.rest).eval();
  REQUIRE(is_flat(sheet, plane));
  CHECK(rigidity_of(sheet, plane).along(0.7) == Approx(before.along(0.7)).epsilon(1e-9));
}

TEST_CASE("the shipped fabrics are read, and each says its source, its place and its method") {
  const std::vector<Fabric> fabrics = read_fabrics(CASES_FOLDER "/fabrics.toml");
  CHECK(fabrics.size() >= 3);
  for (const Fabric& fabric : fabrics) {
    INFO(fabric.name);
    CHECK(fabric.density > 0.02);
    CHECK(fabric.density < 1);
    for (const double B : fabric.rigidity) {  // between tissue and cardboard
      CHECK(B > 1e-7);
      CHECK(B < 1e-2);
    }
    CHECK(!fabric.missing.empty());
  }
  // B = density g c^3 of what was read: 15.00 mm and 14.50 mm at 168 g/m^2
  const Fabric& wool = fabric_named(fabrics, "wool", "here");
  CHECK(wool.rigidity[0] == Approx(0.168 * 9.81 * std::pow(0.015, 3)).epsilon(0.002));
  CHECK(wool.rigidity[1] == Approx(0.168 * 9.81 * std::pow(0.0145, 3)).epsilon(0.002));
}

TEST_CASE(
    "a fabric's ke is its rigidity over what the mesh gives along x; what it cannot carry is "
    "told") {
  const Fabric felt = fabrics_in(one_fabric)[0];
  const TriangleMesh mesh = make_sheet({SheetPattern::one_diagonal, 0.6, 0.6, 60, 60});
  const FabricOnMesh on = fabric_on_mesh(felt, mesh);
  CHECK(on.stiffness == Approx(8e-6 / 0.2).epsilon(0.03));  // a free strip of it has 1/5 of ke
  CHECK(on.stiffness * on.rigidity_ratio == Approx(8e-6).epsilon(1e-12));
  CHECK(on.second_over_first == Approx(1).epsilon(0.03));
  CHECK(on.anisotropy == Approx(4).epsilon(0.05));
  CHECK_THAT(on.report, Contains("0.75 times as stiff") && Contains("felt"));
  const FabricOnMesh curved = fabric_on_mesh(felt, make_cylinder(0.1, 0.3, 20, 8));
  CHECK(std::isnan(curved.second_over_first));
  CHECK(curved.stiffness > 0);
}

TEST_CASE("a fabric without its source, with two rigidities or with a wrong number is refused") {
  const auto refused = [](const std::string& part, const std::string& other,
                          const std::string& words) {
    INFO(part << " -> " << other);
    CHECK_THROWS_WITH(fabrics_in(with(one_fabric, part, other)), Contains(words));
  };
  refused("source = \"a book\"\n", "", "needs the key 'source'");
  refused("\"table 3\"", "\"\"", "'place' is empty");
  refused("second = 6e-6", "second = 0", "'second'");
  refused("source =", "hinge_stiffness = { first = 1e-5, second = 1e-5 }\nsource =", "has one of");
  refused("words", "word", "f.toml");
  CHECK_THROWS_WITH(fabrics_in(std::string(one_fabric) + one_fabric), Contains("is there already"));
  CHECK_THROWS_WITH(fabrics_in("# none\n"), Contains("there is no [[fabric]]"));
  CHECK_THROWS_WITH(fabric_named(fabrics_in(one_fabric), "silk", "a.toml:3"),
                    Contains("a.toml:3: unknown fabric 'silk'; known: felt"));
}
