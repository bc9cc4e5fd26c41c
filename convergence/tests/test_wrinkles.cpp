// Wrinkle measures, on shapes with known answers; and a simulation read back from its file.
#include <catch2/catch.hpp>

#include "convergence/contact/wrinkle_measure.h"
#include "verification/specimens/scratch_folder.h"
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

TEST_CASE("a stored simulation is read back bit for bit, overrides and all") {
  const ScratchFolder folder;
  const Scene scene = read_scene_text(
      "[cloth]\nshape = \"sheet\"\nwidth = 0.3\nheight = 0.2\ncolumns = 3\nrows = 2\n"
      "density = 0.2\n[[object]]\nshape = \"sphere\"\nradius = 0.1\n[time]\nend = 0.1\n",
      "small.toml", {"cloth.width=0.45", "object.0.radius=0.25"});
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
  CHECK(run.scene.objects.size() == 1);
  CHECK(run.times == std::vector<double>{0, 0.1});
  CHECK(run.frame(1).x == s.x);
  CHECK(run.frame(1).v == s.v);
  CHECK_THROWS_WITH(read_stored_run(folder.file("missing.h5")), Catch::Contains("missing.h5"));
}
