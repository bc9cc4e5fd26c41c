// Level sets in files: they come back to the bit, and what is not what was written is refused.
#include <catch2/catch.hpp>
#include <cmath>

#include "reference/bodies/deforming_content.h"
#include "reference/bodies/grid_content.h"
#include "reference/mesh/shapes.h"
#include "verification/files/hdf5_file.h"
#include "verification/files/level_set_cache_file.h"
#include "verification/files/level_set_folder.h"
#include "verification/specimens/scratch_folder.h"
#include "verification/tests/files/raw_hdf5.h"

namespace foldproof {

namespace {

using Catch::Equals;
using Lengths = std::vector<hsize_t>;
using Numbers = std::vector<double>;

const OctreeSettings coarse{Vector3(-0.6, -0.7, -0.65), 1.3, 3, 2, 0.01, 0.2, 0.5, 0.05,
                            HangingNodes::constrained};
const GridMethod method{5, 2, 1.5, MarchingOrder::first};

MeshSequence moving_ball() {
  const TriangleMesh ball = make_icosphere(0.3, 0);
  MeshSequence sequence{ball.triangles, {0.1, 0.4, 0.5}, {}};
  for (int k = 0; k < 3; ++k) sequence.positions.push_back(ball.rest.array() + 0.02 * k);
  return sequence;
}

TriangleSoup egg() {
  PerParticle3 x = make_icosphere(0.4, 0).rest;
  x.row(1) *= 1.5;
  x.row(2) *= 2;
  return {x, make_icosphere(0.4, 0).triangles, {}};
}

const DeformingBody& body() {
  static const DeformingBody made =
      make_deforming_body(moving_ball(), coarse, BetweenFrames::carried);
  return made;
}

DeformingBody read_back(const std::string& path) {
  return read_level_sets(path, "an origin", coarse, BetweenFrames::blended);
}

void remove_set(hid_t file, const std::string& name) {
  made(H5Ldelete(file, name.c_str(), H5P_DEFAULT));
}

/// A dataset in place of one that is there.
template <class T>
void replace(const std::string& path, const std::string& name, const std::vector<T>& values) {
  const RawFile raw(path, H5F_ACC_RDWR);
  remove_set(raw, name);
  const hsize_t count = values.size();
  const hid_t type = std::is_same_v<T, int> ? H5T_NATIVE_INT : H5T_NATIVE_DOUBLE,
              space = made(H5Screate_simple(1, &count, nullptr)),
              set = made(H5Dcreate2(raw, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT,
                                    H5P_DEFAULT));
  made(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()));
  H5Dclose(set);
  H5Sclose(space);
}

void replace_text(const std::string& path, const char* name, const char* text) {
  const RawFile raw(path, H5F_ACC_RDWR);
  const hid_t id = made(H5Aopen(raw, name, H5P_DEFAULT)), type = H5Aget_type(id);
  made(H5Awrite(id, type, &text));
  H5Tclose(type);
  H5Aclose(id);
}

/// A provider that keeps what it makes in a folder, and what it said.
struct Keeper {
  ScratchFolder scratch;
  std::vector<std::string> lines;
  std::string folder = scratch.file("new/cache");
  LevelSetProvider provider =
      caching_provider(folder, [this](const std::string& line) { lines.push_back(line); });

  std::string grid_path() const {
    return folder + "/" + input_key(egg(), method, Repair::refuse) + ".h5";
  }
  std::shared_ptr<const Grid> grid() const {
    return provider.make_level_set(egg(), method, Repair::refuse);
  }
};

bool are_same(const Grid& a, const Grid& b) {
  return a.lattice.origin == b.lattice.origin && a.lattice.spacing == b.lattice.spacing &&
         a.lattice.nodes == b.lattice.nodes && a.phi == b.phi;
}

}  // namespace

TEST_CASE("level set file: a body comes back to the bit, ready for queries") {
  const ScratchFolder scratch;
  const std::string path = scratch.file("a.h5");
  write_level_sets(path, body(), "an origin");
  const DeformingBody read = read_back(path);
  CHECK(read.between == BetweenFrames::blended);
  CHECK(content_key(read) == content_key(body()));
  REQUIRE(read.frames.size() == 3);
  for (std::size_t k = 0; k < 3; ++k) {
    const DeformingFrame &a = read.frames[k], &b = body().frames[k];
    CHECK(a.time == b.time);
    CHECK(a.field.part == b.field.part);
    CHECK(a.field.phi == b.field.phi);
    CHECK(a.to_next == b.to_next);
    CHECK(a.from_previous == b.from_previous);
    CHECK(a.nodes == 0);  // nothing was built
    CHECK(a.searches == 0);
    CHECK(a.field.evaluations == 0);
    CHECK(a.field.settings.reach == coarse.reach);
    CHECK(a.field.start_level == b.field.start_level);
    CHECK(a.field.starts.size() == b.field.starts.size());
    CHECK_FALSE(a.field.starts.empty());
    const Vector3 p(0.1, 0.2, -0.25);
    CHECK(a.field.at(p).phi == b.field.at(p).phi);
  }
}

TEST_CASE("level set file: its arrays have a row for each branch, channel and frame, in metres") {
  const ScratchFolder scratch;
  const std::string path = scratch.file("a.h5");
  write_level_sets(path, body(), "an origin");
  const RawFile raw(path);
  CHECK(raw.text("/", "format") == "foldproof level sets 1");
  CHECK(raw.text("/", "origin") == "an origin");
  CHECK(raw.text("/", "content") == content_key(body()));
  CHECK(raw.numbers("times") == Numbers{0.1, 0.4, 0.5});
  CHECK(raw.text("times", "unit") == "s");
  CHECK_FALSE(raw.has("frames/3"));
  for (const std::size_t k : {0, 1, 2}) {
    const Octree& tree = body().frames[k].field;
    const std::string frame = "frames/" + std::to_string(k);
    const hsize_t channels = tree.phi.size();
    Numbers branches, phi;
    for (const OctreeBranch& branch : tree.branches)
      for (const int value :
           {branch.children, branch.channels, int(branch.inner), int(branch.parts)})
        branches.push_back(value);
    for (const auto& nodes : tree.phi) phi.insert(phi.end(), nodes.begin(), nodes.end());
    CHECK(raw.shape(frame + "/branches") == Lengths{tree.branches.size(), 4});
    CHECK(raw.numbers(frame + "/branches") == branches);
    CHECK(raw.shape(frame + "/part") == Lengths{channels});
    CHECK(raw.shape(frame + "/phi") == Lengths{channels, 27});
    CHECK(raw.numbers(frame + "/phi") == phi);
    CHECK(raw.shape(frame + "/to_next") == Lengths{k < 2 ? channels : 0, 27, 3});
    CHECK(raw.shape(frame + "/from_previous") == Lengths{k > 0 ? channels : 0, 27, 3});
    for (const char* name : {"/phi", "/to_next", "/from_previous"})
      CHECK(raw.text(frame + name, "unit") == "m");
  }
  CHECK(raw.numbers("frames/0/to_next")[82] == body().frames[0].to_next[1][0][1]);
  CHECK(raw.numbers("frames/2/from_previous")[85] == body().frames[2].from_previous[1][1][1]);
}

TEST_CASE("level set file: one of another version, another input or other content is refused") {
  const ScratchFolder scratch;
  const std::string path = scratch.file("a.h5");
  const auto refused = [&](const std::string& why, const auto& change) {
    write_level_sets(path, body(), "an origin");
    change();
    CHECK_THROWS_WITH(read_back(path), Equals(why));
  };
  const std::string other = path + ": its content is not what was written";
  refused(path + ": it holds no level sets of this version",
          [&] { replace_text(path, "format", "foldproof level sets 2"); });
  refused(path + ": it was computed from another mesh, other times or settings",
          [&] { replace_text(path, "origin", "another"); });
  refused(other, [&] { replace_text(path, "content", "0123456789abcdef"); });
  refused(other, [&] { replace(path, "times", Numbers{0.1, 0.3, 0.5}); });
  refused(other, [&] { replace(path, "times", Numbers{0.1, 0.4}); });
  refused(other, [&] { replace(path, "frames/1/part", std::vector<int>{0, 5, 7}); });
  refused(other, [&] { replace(path, "frames/1/branches", std::vector<int>{1, 0, 3, 1}); });
  refused(other, [&] { replace(path, "frames/2/phi", Numbers(54, 0.75)); });
  refused(other, [&] { replace(path, "frames/0/to_next", Numbers(162, 0.75)); });
  refused(other, [&] { replace(path, "frames/1/from_previous", Numbers(81, 0.75)); });
  refused("phi has no whole rows", [&] { replace(path, "frames/2/phi", Numbers(55, 0.75)); });
  refused("to_next has no whole rows",
          [&] { replace(path, "frames/0/to_next", Numbers(81 + 54, 0.75)); });
  refused("from_previous has no whole rows",
          [&] { replace(path, "frames/1/from_previous", Numbers(3, 0.75)); });
}

TEST_CASE("level set file: content that means nothing is refused, though it is what was written") {
  const ScratchFolder scratch;
  const std::string path = scratch.file("a.h5");
  DeformingBody wrong = body();
  wrong.frames[1].time = 0.1;
  write_level_sets(path, wrong, "an origin");
  CHECK_THROWS_WITH(read_back(path),
                    Equals("deforming body, frame 1: its time is not later than that before"));
}

TEST_CASE(
    "level set folder: a grid is computed once, kept under the key of its input, and loaded") {
  const Keeper keeper;
  const auto first = keeper.grid(), again = keeper.grid();
  CHECK(are_same(*first, *make_level_set(egg(), method, Repair::refuse)));
  CHECK(are_same(*again, *first));
  CHECK(keeper.lines == std::vector<std::string>{"level sets kept in " + keeper.grid_path(),
                                                 "level sets loaded from " + keeper.grid_path()});
  const RawFile raw(keeper.grid_path());
  const Lattice& lattice = first->lattice;
  CHECK(raw.text("/", "format") == "foldproof grid 1");
  CHECK(raw.text("/", "origin") == input_key(egg(), method, Repair::refuse));
  CHECK(raw.text("/", "content") == content_key(*first));
  CHECK(raw.shape("nodes") == Lengths{3});
  CHECK(raw.numbers("nodes") == Numbers(lattice.nodes.begin(), lattice.nodes.end()));
  CHECK(raw.shape("corner") == Lengths{3});
  CHECK(raw.numbers("corner") == Numbers{lattice.origin[0], lattice.origin[1], lattice.origin[2]});
  CHECK(raw.shape("spacing") == Lengths{1});
  CHECK(raw.numbers("spacing") == Numbers{lattice.spacing});
  CHECK(raw.numbers("phi") == first->phi);
  for (const char* name : {"corner", "spacing", "phi"}) CHECK(raw.text(name, "unit") == "m");
  CHECK(lattice.nodes[0] != lattice.nodes[1]);
  CHECK(lattice.nodes[1] != lattice.nodes[2]);
}

TEST_CASE("level set folder: a deforming body is computed once, kept and loaded") {
  const Keeper keeper;
  const std::string path = keeper.folder + "/" + input_key(moving_ball(), coarse) + ".h5";
  for (const BetweenFrames between : {BetweenFrames::carried, BetweenFrames::blended}) {
    const auto made = keeper.provider.make_deforming_body(moving_ball(), coarse, between);
    CHECK(content_key(*made) == content_key(body()));
    CHECK(made->between == between);
  }
  CHECK(keeper.lines ==
        std::vector<std::string>{"level sets kept in " + path, "level sets loaded from " + path});
  CHECK(RawFile(path).text("/", "origin") == input_key(moving_ball(), coarse));
}

TEST_CASE("level set folder: a refused file is reported and replaced") {
  const Keeper keeper;
  const std::string path = keeper.grid_path();
  const auto sound = keeper.grid();
  const auto& lattice = sound->lattice;
  std::vector<std::string> expected = {"level sets kept in " + path};
  const auto refused = [&](const std::string& why, const auto& change) {
    change();
    CHECK(are_same(*keeper.grid(), *sound));
    expected.push_back("level sets computed anew, for a file is refused: " + why);
    expected.push_back("level sets kept in " + path);
  };
  refused(path + ": it holds no grid of this version",
          [&] { replace_text(path, "format", "foldproof grid 2"); });
  refused(path + ": it was computed from another mesh or settings",
          [&] { replace_text(path, "origin", "another"); });
  const std::string other = path + ": its content is not what was written",
                    lattice_is_torn = path + ": its lattice is not whole";
  refused(other, [&] { replace_text(path, "content", "0123456789abcdef"); });
  refused(other, [&] { replace(path, "phi", Numbers{3.5, 2.5}); });
  refused(other, [&] { replace(path, "spacing", Numbers{lattice.spacing * 2}); });
  refused(lattice_is_torn, [&] { replace(path, "corner", Numbers{1, 2, 3, 4}); });
  refused(lattice_is_torn, [&] { replace(path, "corner", Numbers{1, 2}); });
  refused(lattice_is_torn, [&] { replace(path, "spacing", Numbers{0.5, 0.25}); });
  refused(lattice_is_torn, [&] { replace(path, "spacing", Numbers{}); });
  refused(lattice_is_torn, [&] { replace(path, "nodes", std::vector<int>{5, 6, 7, 8}); });
  refused(lattice_is_torn, [&] { replace(path, "nodes", std::vector<int>{5, 6}); });
  refused("grid: a value is not finite", [&] {
    Grid wrong = *sound;
    wrong.phi[3] = NAN;
    replace(path, "phi", wrong.phi);
    replace_text(path, "content", content_key(wrong).c_str());
  });
  refused("HDF5: cannot read nodes", [&] { remove_set(RawFile(path, H5F_ACC_RDWR), "nodes"); });
  CHECK(keeper.lines == expected);
}

TEST_CASE("level set folder: one that cannot be made is refused, with what to do") {
  const ScratchFolder scratch;
  const std::string folder = scratch.write("file", "text") + "/cache";
  CHECK_THROWS_AS(caching_provider(folder, [](const std::string&) {}), InputError);
  CHECK_THROWS_WITH(
      caching_provider(folder, [](const std::string&) {}),
      Equals(folder +
             ": cannot make this folder for level sets: Not a directory; choose another --cache"));
}

}  // namespace foldproof
