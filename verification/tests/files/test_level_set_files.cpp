// Level sets in files: they come back to the bit, and what is not what was written is refused.
#include <catch2/catch.hpp>
#include <cmath>

#include "verification/files/deforming_content.h"
#include "verification/files/grid_content.h"
#include "reference/mesh/shapes.h"
#include "verification/files/level_set_cache_file.h"
#include "verification/files/level_set_folder.h"
#include "verification/specimens/scratch_folder.h"
#include "verification/tests/files/hdf5_listing.h"

namespace foldproof {

namespace {

using Catch::Contains;
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

/// Other numbers in place of those of a dataset.
void replace(const std::string& path, const std::string& name, const Numbers& values) {
  const RawFile raw(path);
  made(H5Ldelete(raw, name.c_str(), H5P_DEFAULT));
  const hsize_t count = values.size();
  const hid_t type = H5T_NATIVE_DOUBLE, space = made(H5Screate_simple(1, &count, nullptr)),
              set = made(H5Dcreate2(raw, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT,
                                    H5P_DEFAULT));
  made(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()));
  H5Dclose(set), H5Sclose(space);
}

/// A provider that keeps what it makes in a folder, and what it said.
struct Keeper {
  ScratchFolder scratch;
  std::vector<std::string> lines;
  std::string folder = scratch.file("new/cache");
  LevelSetProvider provider =
      caching_provider(folder, [this](const std::string& line) { lines.push_back(line); });

  std::string path(const std::string& key) const { return folder + "/" + key + ".h5"; }
  std::string grid_path() const { return path(input_key(egg(), method, Repair::refuse)); }
  std::shared_ptr<const Grid> grid() const {
    return provider.make_level_set(egg(), method, Repair::refuse);
  }
};

const char* const changed = "its content is not what was written";

}  // namespace

TEST_CASE("level set file: a body comes back to the bit, ready for queries") {
  const ScratchFolder scratch;
  const std::string path = scratch.file("a.h5");
  write_level_sets(path, body(), "an origin");
  const DeformingBody read = read_back(path);
  CHECK((read.between == BetweenFrames::blended && content_key(read) == content_key(body())));
  REQUIRE(read.frames.size() == 3);
  for (std::size_t k = 0; k < 3; ++k) {
    const DeformingFrame &a = read.frames[k], &b = body().frames[k];
    CHECK((a.time == b.time && a.field.part == b.field.part && a.field.phi == b.field.phi));
    CHECK((a.to_next == b.to_next && a.from_previous == b.from_previous));
    CHECK((a.field.start_level == b.field.start_level && !a.field.starts.empty()));
    CHECK(a.field.starts.size() == b.field.starts.size());
  }
}

TEST_CASE("level set file: content that means nothing is refused, though it is what was written") {
  const ScratchFolder scratch;
  const std::string path = scratch.file("a.h5");
  DeformingBody wrong = body();
  wrong.frames[1].time = 0.1;
  write_level_sets(path, wrong, "an origin");
  CHECK_THROWS_WITH(read_back(path), Contains("frame 1: its time is not later"));
  const auto refused = [&](const char* why, const auto& change) {
    write_level_sets(path, body(), "an origin");
    change();
    CHECK_THROWS_WITH(read_back(path), Contains(why));
  };
  refused("this version", [&] { overwrite_text(RawFile(path), "format", "foldproof grid 1"); });
  refused("another mesh", [&] { overwrite_text(RawFile(path), "origin", "another"); });
  refused(changed, [&] { overwrite(RawFile(path), "times", 1, 0.3); });
  refused("phi has no whole rows", [&] { replace(path, "frames/2/phi", Numbers(55, 0.75)); });
  refused("to_next has no", [&] { replace(path, "frames/0/to_next", Numbers(81 + 54, 0.75)); });
}

TEST_CASE(
    "level set folder: a grid is computed once, kept under the key of its input, and loaded") {
  const Keeper keeper;
  const auto first = keeper.grid(), again = keeper.grid();
  CHECK(content_key(*first) == content_key(*make_level_set(egg(), method, Repair::refuse)));
  CHECK(content_key(*again) == content_key(*first));
  CHECK(keeper.lines == std::vector<std::string>{"level sets kept in " + keeper.grid_path(),
                                                 "level sets loaded from " + keeper.grid_path()});
  const Lattice& lattice = first->lattice;
  Listing expected;
  add_listed(expected, "/", R"(@format = foldproof grid 1; corner@unit = m; spacing@unit = m
    phi@unit = m)");
  expected["/@origin"] = input_key(egg(), method, Repair::refuse);
  expected["/@content"] = content_key(*first);
  expected["/nodes"] = array_text({3}, lattice.nodes);
  expected["/corner"] = array_text({3}, Numbers(lattice.origin.data(), lattice.origin.data() + 3));
  expected["/spacing"] = array_text({1}, Numbers{lattice.spacing});
  expected["/phi"] = array_text({first->phi.size()}, first->phi);
  CHECK(difference_of(hdf5_listing(keeper.grid_path()), expected) == "");
  for (const BetweenFrames between : {BetweenFrames::carried, BetweenFrames::blended}) {
    const auto made = keeper.provider.make_deforming_body(moving_ball(), coarse, between);
    CHECK((content_key(*made) == content_key(body()) && made->between == between));
  }
  CHECK(keeper.lines.back() ==
        "level sets loaded from " + keeper.path(input_key(moving_ball(), coarse)));
}

TEST_CASE("level set folder: a refused file is reported and replaced") {
  Keeper keeper;
  const std::string path = keeper.grid_path();
  const auto sound = keeper.grid();
  Grid wrong = *sound;
  wrong.phi[3] = NAN;
  const auto refused = [&](const char* why, const auto& change) {
    change();
    keeper.lines.clear();
    CHECK(content_key(*keeper.grid()) == content_key(*sound));
    REQUIRE(keeper.lines.size() == 2);
    CHECK_THAT(keeper.lines[0], Contains("refused") && Contains(why));
    CHECK(keeper.lines[1] == "level sets kept in " + path);
  };
  refused("this version", [&] { overwrite_text(RawFile(path), "format", "foldproof grid 2"); });
  refused("another mesh", [&] { overwrite_text(RawFile(path), "origin", "another"); });
  refused(changed, [&] { overwrite(RawFile(path), "phi", 3, 2.5); });
  refused("is not whole", [&] { replace(path, "corner", Numbers{1, 2, 3, 4}); });
  refused("is not whole", [&] { replace(path, "spacing", Numbers{}); });
  refused("a value is not finite", [&] {
    replace(path, "phi", wrong.phi);
    overwrite_text(RawFile(path), "content", content_key(wrong).c_str());
  });
  const std::string folder = keeper.scratch.write("file", "text") + "/cache";
  CHECK_THROWS_AS(caching_provider(folder, {}), InputError);
  CHECK_THROWS_WITH(caching_provider(folder, {}), Contains(folder) && Contains("--cache"));
}

}  // namespace foldproof
