// Wrinkle measures, on shapes with known answers; and a simulation read back from its file.
#include <catch2/catch.hpp>
#include <cmath>

#include "convergence/contact/section_profile.h"
#include "convergence/contact/wrinkle_measure.h"
#include "reference/mesh/shapes.h"
#include "verification/specimens/scratch_folder.h"
#include "verification/files/hdf5_file.h"
#include "reference/bodies/level_set_provider.h"
#include "verification/files/stored_run_file.h"
#include "verification/files/trajectory_file.h"

using namespace foldproof;

TEST_CASE("the dominant wavelength is that of the largest wave, whatever line lies under it") {
  std::vector<double> samples;
  for (int k = 0; k < 200; ++k)
    samples.push_back(0.7 * std::sin(2 * pi * k / 25 + 0.4) + 0.5 * std::cos(2 * pi * k / 8.0) + 3 +
                      0.2 * k);
  CHECK(dominant_wavelength(samples, 0.01) == Approx(0.25));
  CHECK(std::isnan(dominant_wavelength(std::vector<double>(200, 0.0), 0.01)));
  CHECK(std::isnan(dominant_wavelength({1, -1, 1, -1}, 0.01)));
}

TEST_CASE("the deviation is that of the chosen values alone") {
  PerParticle values(5);
  values << 1e9 + 1, 1e9 + 3, 7, 1e9 + 5, -2;
  CHECK(deviation_where(values, [](Eigen::Index i) { return i < 2 || i == 3; }) ==
        Approx(std::sqrt(8.0 / 3)));
  CHECK(std::isnan(deviation_where(values, [](Eigen::Index) { return false; })));
}

TEST_CASE("a section runs straight across a sheet and once round a cylinder") {
  const TriangleMesh sheet = make_sheet({SheetPattern::union_jack, 0.6, 0.4, 8, 7});
  const Section across = section_of(sheet, 0);
  CHECK(across.length.back() == Approx(0.4));
  const PerParticle height = sheet.rest.row(1);
  const std::vector<double> samples = along(across, height, 33);
  for (int k = 0; k < 33; ++k)
    CHECK(std::abs(samples[size_t(k)] - samples[0]) == Approx(0.4 * k / 32).margin(1e-12));
  CHECK(section_of(sheet, 2).crossings.empty());

  const TriangleMesh cylinder = make_cylinder(0.2, 0.5, 24, 6);
  const double side = 2 * 0.2 * std::sin(pi / 24);
  CHECK(section_of(cylinder, 1).length.back() == Approx(24 * side).epsilon(1e-6));
  CHECK(section_of(cylinder, 0).length.back() == Approx(0.5));
}

namespace {

const std::string small_case = R"(title = "A sheet on a ball"
[cloth]
shape = "sheet"
pattern = "alternating"
width = 0.3
height = 0.2
columns = 3
rows = 2
density = 0.2
[[object]]
shape = "sphere"
radius = 0.1
[time]
end = 0.1
)";

}  // namespace

TEST_CASE("a stored simulation is read back bit for bit, overrides and all") {
  const ScratchFolder folder;
  const Scene scene =
      read_scene_text(small_case, "small.toml", {"cloth.width=0.45", "object.0.radius=0.25"});
  const BuiltScene built = build(scene, computing_provider());
  State s = built.start;
  {
    TrajectoryFile file(folder.file("small.h5"), scene, built.system, built.objects, {});
    file.add_frame(s);
    s.time = 0.1;
    s.x.array() += 0.1234567;
    s.v.array() -= 1.0 / 3;
    file.add_frame(s);
    file.finish("", 0, {});
  }
  const StoredRun run = read_stored_run(folder.file("small.h5"));
  CHECK(run.scene.mesh.rest == scene.mesh.rest);
  CHECK(run.scene.text == scene.text);
  REQUIRE(run.scene.objects.size() == 1);
  CHECK(run.times == std::vector<double>{0, 0.1});
  CHECK(run.frame(1).x == s.x);
  CHECK(run.frame(1).v == s.v);
}

TEST_CASE("what is no stored simulation is refused with the file's name") {
  const ScratchFolder folder;
  { Hdf5::create_file(folder.file("other.h5")).attribute("title", std::string("something else")); }
  CHECK_THROWS_WITH(read_stored_run(folder.file("other.h5")),
                    Catch::Contains("other.h5: is no stored simulation"));
  CHECK_THROWS_WITH(read_stored_run(folder.file("missing.h5")), Catch::Contains("missing.h5"));
}
