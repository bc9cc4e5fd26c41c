// Objects, distances and bonds in a simulation's file, read by the library itself.
#include <catch2/catch.hpp>
#include <cmath>

#include "verification/files/trajectory_file.h"
#include "verification/specimens/scratch_folder.h"
#include "verification/tests/files/raw_hdf5.h"
#include "verification/tests/files/trajectory_specimen.h"

namespace foldproof {

namespace {

using Lengths = std::vector<hsize_t>;

}  // namespace

TEST_CASE("trajectory: objects have their surface, and their pose or vertices in each frame") {
  const ScratchFolder scratch;
  const std::string path = scratch.file("a.h5");
  const Scene scene = full_scene();
  {
    TrajectoryFile file(path, scene, system_specimen(), {}, {});
    file.add_frame(state_at(0.5, 1));
    file.add_frame(state_at(1.5, 2));
    file.finish("", 0, {});
  }
  const RawFile raw(path);
  CHECK_FALSE(raw.has("objects/2"));
  for (const int k : {0, 1}) {
    const SceneObject& part = scene.objects[std::size_t(k)];
    const std::string group = "objects/" + std::to_string(k);
    CHECK(raw.text(group, "name") == (k == 0 ? "a ball" : "a body"));
    CHECK(raw.text(group, "shape") == (k == 0 ? "a sphere" : "a mesh"));
    CHECK(raw.number(group, "friction") == (k == 0 ? 0.375 : 0.625));
    CHECK(raw.shape(group + "/triangles") == Lengths{k == 0 ? 3u : 1u, 3});
    CHECK(raw.shape(group + "/vertices") == Lengths{k == 0 ? 5u : 3u, 3});
    CHECK(raw.numbers(group + "/vertices") == numbers_of(part.vertices));
    CHECK(raw.text(group + "/vertices", "unit") == "m");
  }
  CHECK(raw.numbers("objects/0/triangles") == Numbers{0, 1, 2, 1, 4, 3, 2, 3, 4});
  CHECK(raw.numbers("objects/1/triangles") == Numbers{2, 0, 1});
  CHECK_FALSE(raw.has("objects/0/positions"));
  CHECK_FALSE(raw.has("objects/1/rotation"));
  CHECK(raw.shape("objects/0/rotation") == Lengths{2, 4});
  const double length = std::sqrt(25.0 + 9 + 49 + 4);
  const Numbers rotation = raw.numbers("objects/0/rotation");
  for (const std::size_t k : {0, 4}) {
    CHECK(rotation[k] == Approx(5 / length));
    CHECK(rotation[k + 1] == Approx(-3 / length));
    CHECK(rotation[k + 2] == Approx(7 / length));
    CHECK(rotation[k + 3] == Approx(2 / length));
  }
  CHECK(raw.text("objects/0/rotation", "unit") == "1");
  CHECK(raw.shape("objects/0/translation") == Lengths{2, 3});
  CHECK(raw.numbers("objects/0/translation") == Numbers{2, 1, 4.5, 4, -1, 7.5});
  CHECK(raw.text("objects/0/translation", "unit") == "m");
  CHECK(raw.shape("objects/1/positions") == Lengths{2, 3, 3});
  const Numbers positions = raw.numbers("objects/1/positions"), first = numbers_of(rising(3, 22)),
                second = numbers_of(rising(3, 26));
  for (std::size_t k = 0; k < 9; ++k) {
    CHECK(positions[k] == Approx(first[k]));
    CHECK(positions[9 + k] == Approx(second[k]));
  }
  CHECK(raw.text("objects/1/positions", "unit") == "m");
}

TEST_CASE("trajectory: each particle's distance is that to the nearest solid at the frame's time") {
  const ScratchFolder scratch;
  const std::string path = scratch.file("a.h5");
  const std::vector<Object> solids = {
      {"drifts", RigidObject{Sphere{0.5}, {}, drifting()}},
      {"rests", RigidObject{Sphere{1.25}, {turn, {2, 2, 2}}, Motion{}}}};
  {
    TrajectoryFile file(path, bare_scene(), system_specimen(), solids, {});
    for (const double time : {0.5, 1.5}) file.add_frame({time, rising(4, 2 * time), rising(4, 7)});
    file.finish("", 0, {});
  }
  const RawFile raw(path);
  CHECK(raw.shape("frames/object_distance") == Lengths{2, 4});
  CHECK(raw.text("frames/object_distance", "unit") == "m");
  const Numbers phi = raw.numbers("frames/object_distance");
  for (const std::size_t frame : {0, 1}) {
    const double time = frame == 0 ? 0.5 : 1.5;
    const Vector3 centre(1 + 2 * time, 2 - 2 * time, 3 + 3 * time);
    const PerParticle3 x = rising(4, 2 * time);
    for (Eigen::Index i = 0; i < 4; ++i)
      CHECK(phi[4 * frame + std::size_t(i)] ==
            Approx(std::min((x.col(i) - centre).norm() - 0.5,
                            (x.col(i) - Vector3(2, 2, 2)).norm() - 1.25)));
  }
}

TEST_CASE(
    "trajectory: sticky patches are stored, and the bonds of all frames one after the other") {
  const ScratchFolder scratch;
  const std::string path = scratch.file("a.h5");
  const Scene scene = full_scene();
  {
    TrajectoryFile file(path, scene, system_specimen(), {}, {});
    State s = state_at(0.5, 1);
    s.bonds = {{0, 1, 3, {0.125, 0.25, 0.5}}, {1, 7, 0, {0.625, 0.375, -0.75}}};
    file.add_frame(s);
    s.bonds.clear();
    file.add_frame(s);
    s.bonds = {{5, 4, 2, {0.875, 1.5, 2.5}}};
    file.add_frame(s);
    file.finish("", 0, {});
  }
  const RawFile raw(path);
  CHECK(raw.text("sticky/0", "name") == "a palm");
  CHECK(raw.text("sticky/1", "name") == "a seam");
  CHECK(raw.number("sticky/0", "is_cloth") == 0);
  CHECK(raw.number("sticky/1", "is_cloth") == 1);
  CHECK(raw.shape("sticky/0/triangles") == Lengths{2, 3});
  CHECK(raw.numbers("sticky/0/triangles") == Numbers{0, 1, 2, 2, 1, 3});
  CHECK(raw.numbers("sticky/1/triangles") == Numbers{1, 3, 2});
  CHECK(raw.numbers("sticky/0/particles") == Numbers{3, 1, 2});
  CHECK(raw.numbers("sticky/1/particles") == Numbers{0});
  CHECK_FALSE(raw.has("sticky/2"));
  CHECK(raw.numbers("sticky/bond_counts") == Numbers{2, 0, 1});
  CHECK(raw.shape("sticky/bonds") == Lengths{3, 3});
  CHECK(raw.numbers("sticky/bonds") == Numbers{0, 1, 3, 1, 7, 0, 5, 4, 2});
  CHECK(raw.shape("sticky/places") == Lengths{3, 3});
  CHECK(raw.numbers("sticky/places") ==
        Numbers{0.125, 0.25, 0.5, 0.625, 0.375, -0.75, 0.875, 1.5, 2.5});
  CHECK(raw.text("sticky/bond_counts", "unit") == "1");
  CHECK(raw.text("sticky/bonds", "unit") == "1");
  CHECK(raw.text("sticky/places", "unit") == "1, 1, m");
}

}  // namespace foldproof
