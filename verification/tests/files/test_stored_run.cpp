// Simulations read back from their files, which other programs may have written.
#include <catch2/catch.hpp>
#include <numeric>

#include "reference/types.h"
#include "verification/files/hdf5_file.h"
#include "verification/files/stored_run_file.h"
#include "verification/specimens/scratch_folder.h"

namespace foldproof {

namespace {

using Catch::Matchers::Contains;

/// Values that differ: 0.5, 1.75, 3, ...
std::vector<double> ramp(size_t count, double first = 0.5) {
  std::vector<double> values(count);
  for (size_t k = 0; k < count; ++k) values[k] = first + 1.25 * double(k);
  return values;
}

/// A file of the motion alone, of five particles in three frames.
struct FramesFile {
  ScratchFolder scratch;
  std::string path = scratch.file("frames.h5");
  std::vector<int> corners{3, 1, 4, 2, 0, 3};
  std::vector<double> times{0.25, 0.5, 1.75}, positions = ramp(45);

  void write() const {
    const Hdf5 file = Hdf5::create_file(path);
    file.group("mesh").array("triangles", {corners.size()}, corners.data());
    const Hdf5 frames = file.group("frames");
    frames.dataset("time", times);
    frames.dataset("positions", positions);
  }
  StoredFrames read() const {
    write();
    return read_stored_frames(path);
  }
};

const char* const misshapen =
    ": its positions are not three a particle in every frame, or its triangles not of three";

/// A sheet of 4 x 3 particles.
const std::string small_case = R"([cloth]
shape = "sheet"
width = 0.75
height = 0.5
columns = 3
rows = 2
density = 0.2
# --set cloth.density=0.7
[time]
end = 0.7
)";

/// A stored simulation of two frames of 12 particles.
struct RunFile {
  ScratchFolder scratch;
  std::string path = scratch.file("run.h5"), text = small_case, folder = "some/folder";
  std::vector<double> times{0.25, 0.75}, positions = ramp(72), velocities = ramp(72, -3.75);

  StoredRun read() const {
    {
      const Hdf5 file = Hdf5::create_file(path);
      file.attribute("case_folder", folder);
      file.attribute("case_name", std::string("small"));
      file.attribute("case_text", text);
      file.attribute("title", std::string("A title of its own"));
      const Hdf5 frames = file.group("frames");
      frames.dataset("time", times);
      frames.dataset("positions", positions);
      frames.dataset("velocities", velocities);
    }
    return read_stored_run(path);
  }
};

const char* const unfit = ": its frames are not of the 12 particles that its case says";

}  // namespace

TEST_CASE("stored frames: triangles, times and positions are read as they are") {
  const FramesFile file;
  const StoredFrames run = file.read();
  CHECK(run.triangles == std::vector<Triangle>{{3, 1, 4}, {2, 0, 3}});
  CHECK(run.times == file.times);
  CHECK(run.positions == file.positions);
  for (size_t k = 0; k < 3; ++k) {
    const PerParticle3 frame = run.frame(k);
    REQUIRE(frame.cols() == 5);
    for (int p = 0; p < 5; ++p)
      for (int c = 0; c < 3; ++c)
        CHECK(frame(c, p) == file.positions[15 * k + 3 * size_t(p) + size_t(c)]);
  }
}

TEST_CASE("stored frames: positions need three numbers a particle in each frame") {
  for (const size_t count : {43u, 46u, 48u, 42u, 51u}) {
    FramesFile file;
    file.positions = ramp(count);
    CHECK_THROWS_WITH(file.read(), file.path + misshapen);
    CHECK_THROWS_AS(file.read(), InputError);
  }
  FramesFile still;
  still.times.clear(), still.positions.clear();
  CHECK_THROWS_WITH(still.read(), still.path + misshapen);
  FramesFile one;
  one.times.resize(1);  // 15 particles
  CHECK(one.read().frame(0).cols() == 15);
}

TEST_CASE("stored frames: triangles are of three particles that are there") {
  FramesFile file;
  file.corners.pop_back();
  CHECK_THROWS_WITH(file.read(), file.path + misshapen);
  file.corners = {3, 1, 4, 2, 0, 5};
  CHECK_THROWS_WITH(file.read(), file.path + ": a triangle names particle 5 of 5");
  CHECK_THROWS_AS(file.read(), InputError);
  file.corners = {3, -1, 4};
  CHECK_THROWS_WITH(file.read(), file.path + ": a triangle names particle -1 of 5");
}

TEST_CASE("stored frames: a file that lacks one of them is refused by its name") {
  for (const char* lacking : {"mesh", "time", "positions", "all"}) {
    const FramesFile whole;
    {
      const Hdf5 file = Hdf5::create_file(whole.path);
      const std::string what = lacking;
      if (what != "mesh" && what != "all")
        file.group("mesh").array("triangles", {6}, whole.corners.data());
      if (what != "all") {
        const Hdf5 frames = file.group("frames");
        if (what != "time") frames.dataset("time", whole.times);
        if (what != "positions") frames.dataset("positions", whole.positions);
      }
    }
    CHECK_THROWS_WITH(read_stored_frames(whole.path),
                      Catch::StartsWith(whole.path + ": is no stored simulation: "));
    CHECK_THROWS_AS(read_stored_frames(whole.path), InputError);
  }
}

TEST_CASE("stored run: its case, its title and its frames are read") {
  const RunFile file;
  const StoredRun run = file.read();
  CHECK(run.scene.name == "small");
  CHECK(run.scene.folder == "some/folder");
  CHECK(run.scene.title == "A title of its own");
  CHECK(run.scene.text == small_case);
  CHECK(run.scene.density == 0.2);  // what looks like an override stands within the text
  CHECK(run.times == file.times);
  CHECK(run.positions == file.positions);
  CHECK(run.velocities == file.velocities);
  for (size_t k = 0; k < 2; ++k) {
    const State s = run.frame(k);
    CHECK(s.time == file.times[k]);
    REQUIRE((s.x.cols() == 12 && s.v.cols() == 12));
    for (int p = 0; p < 12; ++p)
      for (int c = 0; c < 3; ++c) {
        const size_t at = 36 * k + 3 * size_t(p) + size_t(c);
        CHECK((s.x(c, p) == file.positions[at] && s.v(c, p) == file.velocities[at]));
      }
  }
}

TEST_CASE("stored run: overrides at the end of the text are applied in their order") {
  RunFile file;
  file.text += "\n# --set cloth.density=0.4\n# --set cloth.density=0.3\n# --set time.end=0.9";
  const Scene scene = file.read().scene;
  CHECK(scene.density == 0.3);
  CHECK(scene.schedule.end == 0.9);
  CHECK(scene.text == file.text);
  file.text = small_case + "\n# --set cloth.density=0.4\n# a comment\n# --set time.end=0.9";
  CHECK(file.read().scene.density == 0.2);  // only the last lines are
  CHECK(file.read().scene.schedule.end == 0.9);
  file.text = small_case + "\n# --set cloth.density=0.4\n";  // not the last: a line ends after it
  CHECK(file.read().scene.density == 0.2);
}

TEST_CASE("stored run: a text of overrides alone is a case, too") {
  RunFile file;
  file.text.clear();
  for (const char* assignment :
       {"cloth.shape=sheet", "cloth.width=0.75", "cloth.height=0.5", "cloth.columns=3",
        "cloth.rows=2", "cloth.density=0.6", "time.end=0.9"})
    file.text += std::string("\n# --set ") + assignment;
  const Scene scene = file.read().scene;
  CHECK(scene.density == 0.6);
  CHECK(scene.mesh.particles() == 12);
}

TEST_CASE("stored run: an invalid case is refused with the place in its text") {
  RunFile file;
  file.text = "[cloth]\nshape = \"no such\"\n";
  CHECK_THROWS_WITH(file.read(), Catch::StartsWith("some/folder/small.toml:"));
  CHECK_THROWS_AS(file.read(), InputError);
}

TEST_CASE("stored run: frames that are not of the case's particles are refused") {
  RunFile shorter, slower, still, more;
  shorter.positions.resize(69);
  slower.velocities.resize(36);
  still.times.clear(), still.positions.clear(), still.velocities.clear();
  more.times.push_back(1.5);
  for (const RunFile* file : {&shorter, &slower, &still, &more}) {
    CHECK_THROWS_WITH(file->read(), file->path + unfit);
    CHECK_THROWS_AS(file->read(), InputError);
  }
}

TEST_CASE("stored run: what holds no simulation is refused by its name") {
  const ScratchFolder scratch;
  const std::string path = scratch.file("other.h5");
  Hdf5::create_file(path).attribute("title", std::string("something else"));
  CHECK_THROWS_WITH(read_stored_run(path), Catch::StartsWith(path + ": is no stored simulation: "));
  CHECK_THROWS_AS(read_stored_run(path), InputError);
}

}  // namespace foldproof
