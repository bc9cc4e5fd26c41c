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

TEST_CASE("values are refused beyond their limits, which they may reach", "[scene]") {
  const auto keys = table(
      "zero = 0\nleast = 5e-324\nbelow = -5e-324\none = 1\n"
      "most = 1000000000\nmore = 1000000001\n");
  CHECK(positive(*keys, "least") == 5e-324);
  CHECK(positive_or(*keys, "absent", 0) == 0);
  CHECK(non_negative_or(*keys, "zero", 7) == 0);
  CHECK(non_negative_or(*keys, "absent", 7) == 7);
  CHECK(count_or(*keys, "one", 7) == 1);
  CHECK(count_or(*keys, "most", 7) == 1'000'000'000);
  CHECK(count_or(*keys, "absent", 7) == 7);
  CHECK_NOTHROW(reject_many_triangles(*keys, "one", 12345, {12345, 3}));
  CHECK_THROWS_WITH(positive(*keys, "zero"), "some.toml:2: 'zero' must be > 0");
  CHECK_THROWS_WITH(positive_or(*keys, "zero", 7), "some.toml:2: 'zero' must be > 0");
  CHECK_THROWS_WITH(non_negative_or(*keys, "below", 7), Contains("'below' must not be negative"));
  CHECK_THROWS_WITH(count_or(*keys, "zero", 7), Contains("must lie in 1 .. 1,000,000,000"));
  CHECK_THROWS_WITH(count_or(*keys, "more", 7), Contains("must lie in 1 .. 1,000,000,000"));
  CHECK_THROWS_WITH(reject_many_triangles(*keys, "one", 12346, {12345, 3}),
                    Contains("some.toml:5: 'one' asks for 1.235e+04 triangles"));
}

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

TEST_CASE("an error without a place gets one, and others keep theirs", "[scene]") {
  using Texts = std::vector<std::pair<std::string, std::string>>;
  for (const auto& [thrown, becomes] : Texts{{"radius is 0", "some.toml:7: radius is 0"},
                                             {"some.toml:9: is 0", "some.toml:9: is 0"},
                                             {"--set a=0: is 0", "--set a=0: is 0"}}) {
    const auto fail = [&]() -> int { throw InputError(thrown); };
    CHECK_THROWS_WITH(with_error_location("some.toml:7", fail), becomes);
  }
  CHECK(with_error_location("some.toml:7", [] { return 42; }) == 42);
}
