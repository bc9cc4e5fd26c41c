// Folders of checkpoints: whose they are, which count, and what is removed from them.
#include <catch2/catch.hpp>
#include <fstream>

#include "verification/files/checkpoint_file.h"
#include "verification/specimens/scratch_folder.h"

namespace foldproof {

namespace {

namespace fs = std::filesystem;
using Catch::Contains;
using Catch::Equals;

const RunIdentity mine{"a case", "0123", "foldproof 9.8"};

CheckpointRecord record_of(long frame) {
  CheckpointRecord record;
  record.at.frame = frame;
  for (const double earlier : {0.25, 0.0})
    record.at.past.push_back({3.5 + double(frame) - earlier, PerParticle3::Constant(3, 2, 1.5),
                              PerParticle3::Constant(3, 2, 2.5)});
  return record;
}

/// A folder of so many checkpoints of this run.
CheckpointFolder folder_of(const ScratchFolder& scratch, long frames) {
  const CheckpointFolder folder(scratch.file("run"), mine);
  for (long frame = 0; frame < frames; ++frame) folder.write(record_of(frame));
  return folder;
}

struct Replayed {
  std::vector<long> frames;
  std::vector<std::string> lines;
  std::optional<Checkpoint> last;
};

Replayed replay(const CheckpointFolder& folder) {
  Replayed r;
  r.last =
      folder.replay([&](const CheckpointRecord& record) { r.frames.push_back(record.at.frame); },
                    [&](const std::string& line) { r.lines.push_back(line); });
  return r;
}

void write_new(const std::string& path) { std::ofstream(path) << "x"; }

Scene scene_specimen() {
  Scene scene;
  scene.text = "the text of the case";
  scene.mesh.rest = PerParticle3::Constant(3, 4, 1.5);
  scene.x = PerParticle3::Constant(3, 4, 2.5);
  scene.v = PerParticle3::Constant(3, 4, 3.5);
  scene.mesh.triangles = {{0, 1, 2}, {1, 3, 2}};
  SceneObject still, moving;
  still.vertices = PerParticle3::Constant(3, 5, 4.5);
  still.triangles = {{2, 1, 4}};
  moving.vertices = PerParticle3::Constant(3, 3, 5.5);
  moving.animation = std::make_shared<const MeshSequence>(
      MeshSequence{{}, {}, {PerParticle3::Constant(3, 3, 5.5), PerParticle3::Constant(3, 3, 6.5)}});
  scene.objects = {still, moving};
  StickyPatch patch;
  patch.triangles = {{3, 1, 0}};
  patch.particles = {2, 3};
  scene.sticky = {patch};
  return scene;
}

}  // namespace

TEST_CASE("checkpoints: the identity of a run is its text, its program and a key of all geometry") {
  const Scene scene = scene_specimen();
  const RunIdentity one = identity_of(scene, "program 7");
  CHECK(one.case_text == "the text of the case");
  CHECK(one.program == "program 7");
  CHECK(one.meshes.size() == 16);
  CHECK(identity_of(scene_specimen(), "program 8").meshes == one.meshes);
  using Change = std::function<void(Scene&)>;
  const std::vector<Change> changes = {
      [](Scene& s) { s.mesh.rest(2, 3) += 1; }, [](Scene& s) { s.x(0, 1) += 1; },
      [](Scene& s) { s.v(1, 2) += 1; },
      [](Scene& s) {
        s.mesh.triangles[1] = {1, 3, 0};
      },
      [](Scene& s) { s.objects[0].vertices(2, 4) += 1; },
      [](Scene& s) {
        s.objects[0].triangles[0] = {2, 1, 3};
      },
      [](Scene& s) {
        MeshSequence sequence = *s.objects[1].animation;
        sequence.positions[1](1, 1) += 1;
        s.objects[1].animation = std::make_shared<const MeshSequence>(sequence);
      },
      [](Scene& s) {
        s.sticky[0].triangles[0] = {3, 1, 2};
      },
      [](Scene& s) { s.sticky[0].particles[1] = 1; },
      // the same numbers in other arrays
      [](Scene& s) {
        s.mesh.rest.setConstant(2.5);
        s.x.resize(3, 3);
        s.x.setConstant(2.5);
        s.v = PerParticle3::Constant(3, 5, 2.5);
      }};
  std::vector<std::string> keys = {one.meshes};
  for (const Change& change : changes) {
    Scene other = scene_specimen();
    change(other);
    keys.push_back(identity_of(other, "program 7").meshes);
  }
  Scene even = scene_specimen();
  for (PerParticle3* x : {&even.mesh.rest, &even.x, &even.v}) x->setConstant(2.5);
  keys.push_back(identity_of(even, "program 7").meshes);
  std::ranges::sort(keys);
  CHECK(std::ranges::adjacent_find(keys) == keys.end());
}

TEST_CASE("checkpoints: those of another case, other meshes or another program are named") {
  const ScratchFolder scratch;
  folder_of(scratch, 2);
  const std::string text = "another case text, or other overrides", meshes = "other meshes",
                    program = "another program (foldproof 9.8, this is new)";
  const std::vector<std::pair<RunIdentity, std::string>> others = {
      {{"b", "0123", "foldproof 9.8"}, text},
      {{"a case", "b", "foldproof 9.8"}, meshes},
      {{"a case", "0123", "new"}, program},
      {{"b", "b", "foldproof 9.8"}, text + "; " + meshes},
      {{"b", "0123", "new"}, text + "; " + program},
      {{"a case", "b", "new"}, meshes + "; " + program},
      {{"b", "b", "new"}, text + "; " + meshes + "; " + program}};
  for (const auto& [identity, differs] : others) {
    const CheckpointFolder folder(scratch.file("run"), identity);
    CHECK_THROWS_AS(replay(folder), InputError);
    CHECK_THROWS_WITH(
        replay(folder),
        Equals(
            scratch.file("run/000000.h5") + ": this checkpoint is of " + differs +
            ". Resume with what it was made with, or start over with --restart, which deletes it"));
    const auto kept = folder.kept_run();
    REQUIRE(kept);
    CHECK(kept->differs == differs);
    CHECK(kept->frame == 1);
  }
  CHECK(fs::exists(scratch.file("run/000001.h5")));
}

TEST_CASE(
    "checkpoints: a folder is replayed up to the first damaged one, which goes with the rest") {
  const ScratchFolder scratch;
  const CheckpointFolder folder = folder_of(scratch, 5);
  write_new(scratch.file("run/000003.h5"));
  const Replayed r = replay(folder);
  CHECK(r.frames == std::vector<long>{0, 1, 2});
  REQUIRE(r.lines.size() == 1);
  CHECK_THAT(r.lines[0], Catch::StartsWith(scratch.file("run/000003.h5") +
                                           ": this checkpoint is damaged and left out: HDF5"));
  REQUIRE(r.last);
  CHECK(r.last->frame == 2);
  CHECK(fs::exists(scratch.file("run/000002.h5")));
  CHECK_FALSE(fs::exists(scratch.file("run/000003.h5")));
  CHECK_FALSE(fs::exists(scratch.file("run/000004.h5")));
}

TEST_CASE("checkpoints: those after a gap are removed, and a folder of none has none") {
  const ScratchFolder scratch;
  const CheckpointFolder folder = folder_of(scratch, 4);
  fs::remove(scratch.file("run/000001.h5"));
  CHECK(replay(folder).frames == std::vector<long>{0});
  CHECK(fs::exists(scratch.file("run/000000.h5")));
  CHECK_FALSE(fs::exists(scratch.file("run/000002.h5")));
  fs::remove(scratch.file("run/000000.h5"));
  const Replayed none = replay(folder);
  CHECK_FALSE(none.last);
  CHECK(none.lines.empty());
  CHECK_FALSE(fs::exists(scratch.file("run")));
  CHECK_FALSE(replay(folder).last);
}

TEST_CASE("checkpoints: the run that is kept is that of the last sound one before a gap") {
  const ScratchFolder scratch;
  CHECK_FALSE(CheckpointFolder(scratch.file("run"), mine).kept_run());
  const CheckpointFolder one = folder_of(scratch, 1);
  REQUIRE(one.kept_run());
  CHECK(one.kept_run()->frame == 0);
  CHECK(one.kept_run()->time == 3.5);
  const CheckpointFolder folder = folder_of(scratch, 5);
  CHECK(folder.kept_run()->frame == 4);
  CHECK(folder.kept_run()->time == 7.5);
  CHECK(folder.kept_run()->differs == "");
  write_new(scratch.file("run/000004.h5"));
  write_new(scratch.file("run/000003.h5"));
  CHECK(folder.kept_run()->frame == 2);
  CHECK(folder.kept_run()->time == 5.5);
  fs::remove(scratch.file("run/000002.h5"));
  CHECK(folder.kept_run()->frame == 1);
  for (const char* name : {"run/000000.h5", "run/000001.h5"}) write_new(scratch.file(name));
  REQUIRE(folder.kept_run());
  CHECK(folder.kept_run()->frame == -1);
  CHECK(folder.kept_run()->time == 0);
  CHECK(folder.kept_run()->differs == "");
  CHECK(fs::exists(scratch.file("run/000004.h5")));
}

TEST_CASE(
    "checkpoints: from one on they are removed, partial ones all, files of other names never") {
  const ScratchFolder scratch;
  const CheckpointFolder folder(scratch.file("run"), mine);
  fs::create_directory(scratch.file("run"));
  const std::vector<std::string> gone = {
      "000005.h5",         "000006.h5",         "123456.h5",        "1234567.h5",
      "000000.h5.partial", "000004.h5.partial", "000009.h5.partial"};
  const std::vector<std::string> stay = {
      "000000.h5",       "000004.h5", "00007.h5",           "00008x.h5",
      "x00007.h5",       "-00007.h5", "000007.txt",         "notes.partial",
      "000007.partial",  "000007",    "000007.txt.partial", "99999999999999999999.h5",
      "00007.h5.partial"};
  for (const auto* names : {&gone, &stay})
    for (const std::string& name : *names) write_new(scratch.file("run/" + name));
  folder.remove_from(5);
  for (const std::string& name : gone) {
    INFO(name);
    CHECK_FALSE(fs::exists(scratch.file("run/" + name)));
  }
  for (const std::string& name : stay) {
    INFO(name);
    CHECK(fs::exists(scratch.file("run/" + name)));
  }
  folder.remove_from(0);
  CHECK_FALSE(fs::exists(scratch.file("run/000000.h5")));
  CHECK_FALSE(fs::exists(scratch.file("run/000004.h5")));
  CHECK(fs::exists(scratch.file("run/00007.h5")));
}

TEST_CASE("checkpoints: the latest is removed first, and what cannot be is named") {
  const ScratchFolder scratch;
  const CheckpointFolder folder(scratch.file("run"), mine);
  const auto path = [&](int frame) {
    return scratch.file("run/0000" + std::to_string(frame) + ".h5");
  };
  fs::create_directories(path(30) + "/full");
  for (int frame = 10; frame < 50; ++frame)
    if (frame != 30) write_new(path(frame));
  CHECK_THROWS_WITH(folder.remove_from(12),
                    Equals(path(30) + ": cannot be removed: Directory not empty"));
  for (int frame = 10; frame < 50; ++frame) CHECK(fs::exists(path(frame)) == (frame <= 30));
}

TEST_CASE("checkpoints: nothing is removed where there is no folder, and a file is no folder") {
  const ScratchFolder scratch;
  CHECK_NOTHROW(CheckpointFolder(scratch.file("missing"), mine).remove_from(0));
  const std::string file = scratch.write("file", "text");
  CHECK_THROWS_WITH(CheckpointFolder(file, mine).remove_from(0),
                    Equals(file + ": is no folder; checkpoints would come to lie there"));
  CHECK_THROWS_WITH(CheckpointFolder(file + "/run", mine).write(record_of(0)),
                    Equals(file + "/run: cannot make this folder: Not a directory"));
}

}  // namespace foldproof
