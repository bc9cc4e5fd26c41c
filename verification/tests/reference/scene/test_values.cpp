// Values that several tables share: their limits, motions, and paths.
#include <catch2/catch.hpp>
#include <filesystem>

#include "reference/scene/key_values.h"
#include "reference/scene/scene_limits.h"
#include "verification/specimens/scratch_folder.h"
#include "verification/tests/reference/scene/scene_texts.h"

using namespace foldproof;
using Catch::Matchers::Contains;

namespace {

/// A table whose keys begin on line 2.
std::shared_ptr<KeyTable> table(const std::string& keys) {
  return parse_keys("[t]\n" + keys, "some.toml")->table("t");
}

const std::string leaves_folder = "' leaves the case file's folder";
const std::string lies_outside = "' lies outside the case file's folder";

}  // namespace

TEST_CASE("a file lies in a folder, or below it, or outside, links followed", "[scene]") {
  const ScratchFolder scratch;
  namespace fs = std::filesystem;
  const std::string inner = scratch.file("inner"), beside = scratch.file("inner2");
  fs::create_directories(inner + "/below");
  fs::create_directories(beside);
  fs::create_directory_symlink(beside, inner + "/link");
  fs::create_directory_symlink(inner + "/below", inner + "/loop");
  for (const std::string& folder : {inner, inner + "/"}) {
    for (const std::string good : {"/a.obj", "/below/a.obj", "/loop/a.obj", ""})
      CHECK_NOTHROW(reject_outside(inner + good, folder, "w"));
    check_refused([&](const std::string& file) { reject_outside(file, folder, "w:3"); },
                  {{beside + "/a.obj", "w:3: '" + beside + "/a.obj" + lies_outside},
                   {inner + "/link/a.obj", lies_outside},
                   {scratch.file("a.obj"), lies_outside}});
  }
  const std::string absent = scratch.file("absent");
  CHECK_NOTHROW(reject_outside(absent + "/a.obj", absent + "/", "w"));
  CHECK_NOTHROW(reject_outside("below/a.obj", "", "w"));
  CHECK_THROWS_WITH(reject_outside("../a.obj", "", "w"), Contains("w: '../a.obj" + lies_outside));
}

TEST_CASE("a path of a case is relative to its folder, one of --set is as typed", "[scene]") {
  const ScratchFolder scratch;
  const std::string folder = scratch.file("");
  const auto path = [&](const std::string& named) {
    return path_of(*table("\nmesh = \"" + named + "\"\n"), "mesh", folder);
  };
  CHECK(path("below/a.obj") == folder + "below/a.obj");
  CHECK(path("..a.obj") == folder + "..a.obj");
  CHECK(path("").empty());
  std::filesystem::create_directory_symlink(std::filesystem::temp_directory_path(),
                                            scratch.file("link"));
  check_refused(path, {{"../a.obj", "some.toml:3: '../a.obj" + leaves_folder},
                       {"below/../a.obj", leaves_folder},
                       {"below/..", leaves_folder},
                       {folder + "a.obj", leaves_folder},
                       {"link/a.obj", "some.toml:3: '" + folder + "link/a.obj" + lies_outside}});
  const auto keys = table("mesh = \"b.obj\"\n");
  for (const std::string typed : {"../a.obj", "/a.obj"}) {
    set_key(*keys, "mesh=" + typed);
    CHECK(path_of(*keys, "mesh", folder) == typed);
  }
}
