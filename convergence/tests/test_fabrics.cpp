// Rigidity of meshes by direction, and measured fabrics on them.
#include <catch2/catch.hpp>

#include "reference/mesh/rigidity_map.h"
#include "reference/mesh/shapes.h"
#include "reference/scene/fabrics.h"
#include "reference/types.h"
#include "verification/oracles/homogenised_bending.h"
#include "verification/specimens/scratch_folder.h"

using namespace foldproof;
using Catch::Matchers::Contains;

namespace {

constexpr double degree = pi / 180;

Rigidity rigidity_of_flat(const TriangleMesh& mesh) {
  RestPlane plane;
  REQUIRE(is_flat(mesh, plane));
  return rigidity_of(mesh, plane);
}

const std::string one_fabric = R"([[fabric]]
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
  return read_fabrics(folder.write("f.toml", text));
}

}  // namespace

TEST_CASE("a large sheet has the rigidity of its homogenised cell, in every direction") {
  const auto rising = [](int, int) { return true; };
  const Eigen::Matrix3d cell =
      oracles::forced_rigidity(oracles::split_rectangles({1, 1, 1, 1, rising}));
  TriangleMesh mesh = make_sheet({SheetPattern::one_diagonal, 0.6, 0.6, 60, 60});
  const Rigidity sheet = rigidity_of_flat(mesh);
  for (const double angle : {0.0, 20.0, 45.0, 90.0, 135.0}) {
    INFO(angle);
    CHECK(sheet.along(angle * degree) ==
          Approx(oracles::cylinder_rigidity(cell, angle * degree)).epsilon(0.03));
    CHECK(sheet.of_strip(angle * degree) ==
          Approx(oracles::strip_rigidity(cell, angle * degree)).epsilon(0.03));
  }
  const RigidityExtremes extremes = extremes_of(sheet);
  CHECK(extremes.greatest_angle == Approx(45 * degree).margin(2 * degree));
  CHECK(extremes.anisotropy() == Approx(4).epsilon(0.03));  // 3/4 over 3/16
  mesh.rest = (Eigen::AngleAxisd(0.5, Vector3::UnitX()).matrix() * mesh.rest).eval();
  CHECK(rigidity_of_flat(mesh).along(0.7) == Approx(sheet.along(0.7)).epsilon(1e-9));
}

TEST_CASE(
    "around a particle inside, rigidity is that of the pattern; equilateral ones are isotropic") {
  const TriangleMesh mesh = make_sheet({SheetPattern::equilateral, 0.12, 0, 12, 12});
  int inside = 0;
  const std::vector<RigidityExtremes> around = rigidity_around_particles(mesh);
  for (int i = 0; i < mesh.particles(); ++i) {
    const Vector3 x = mesh.rest.col(i);
    if (x.x() < 0.025 || x.x() > 0.095 || x.y() < 0.025 || x.y() > 0.075) continue;
    ++inside;
    CHECK(around[size_t(i)].anisotropy() == Approx(1).epsilon(1e-9));
    CHECK(around[size_t(i)].least == Approx(0.25).epsilon(1e-9));
  }
  CHECK(inside > 10);
}

TEST_CASE(
    "a fabric's ke is its rigidity over what the mesh gives along x; what it cannot carry is "
    "told") {
  const Fabric felt = fabrics_in(one_fabric)[0];
  const FabricOnMesh on =
      fabric_on_mesh(felt, make_sheet({SheetPattern::one_diagonal, 0.6, 0.6, 60, 60}));
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
  struct Slip {
    std::string part, other, words;
  };
  for (const Slip& slip :
       {Slip{"source = \"a book\"\n", "", "needs the key 'source'"},
        {"\"table 3\"", "\"\"", "'place' is empty"},
        {"second = 6e-6", "second = 0", "'second'"},
        {"source =", "hinge_stiffness = { first = 1e-5, second = 1e-5 }\nsource =", "has one of"},
        {"words", "word", "f.toml"}}) {
    std::string text = one_fabric;
    text.replace(text.find(slip.part), slip.part.size(), slip.other);
    CHECK_THROWS_WITH(fabrics_in(text), Contains(slip.words));
  }
  CHECK_THROWS_WITH(fabrics_in(one_fabric + one_fabric), Contains("is there already"));
  CHECK_THROWS_WITH(fabrics_in("# none\n"), Contains("there is no [[fabric]]"));
  CHECK_THROWS_WITH(fabric_named(fabrics_in(one_fabric), "silk", "a.toml:3"),
                    Contains("a.toml:3: unknown fabric 'silk'; known: felt"));
}
