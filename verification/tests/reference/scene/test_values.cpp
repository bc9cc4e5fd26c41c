// Values that several tables share: their limits, motions, and paths.
#include <catch2/catch.hpp>
#include <filesystem>
#include <limits>

#include "reference/scene/key_values.h"
#include "reference/scene/scene_limits.h"
#include "verification/specimens/scratch_folder.h"

using namespace foldproof;
using Catch::Matchers::Contains;
using Catch::Matchers::EndsWith;

namespace {

/// A table whose keys begin on line 2.
std::shared_ptr<KeyTable> table(const std::string& keys) {
  return parse_keys("[t]\n" + keys, "some.toml")->table("t");
}

const std::string leaves =
    "' leaves the case file's folder; put the file there, or name it by --set";
const std::string lies_outside =
    "' lies outside the case file's folder; put it there, or name it by --set";

}  // namespace

TEST_CASE("positive values exclude zero; others that must not be negative include it", "[scene]") {
  const auto keys = table("zero = 0\nleast = 5e-324\nbelow = -5e-324\n");
  CHECK(positive(*keys, "least") == 5e-324);
  CHECK_THROWS_WITH(positive(*keys, "zero"), "some.toml:2: 'zero' must be > 0");
  CHECK_THROWS_WITH(positive(*keys, "below"), "some.toml:4: 'below' must be > 0");
  CHECK(positive_or(*keys, "least", 7) == 5e-324);
  CHECK(positive_or(*keys, "absent", 7) == 7);
  CHECK(positive_or(*keys, "absent", 0) == 0);
  CHECK_THROWS_WITH(positive_or(*keys, "zero", 7), "some.toml:2: 'zero' must be > 0");
  CHECK(non_negative_or(*keys, "zero", 7) == 0);
  CHECK(non_negative_or(*keys, "least", 7) == 5e-324);
  CHECK(non_negative_or(*keys, "absent", 7) == 7);
  CHECK_THROWS_WITH(non_negative_or(*keys, "below", 7),
                    "some.toml:4: 'below' must not be negative");
}

TEST_CASE("a count lies in 1 to 1,000,000,000, and both are counts", "[scene]") {
  const auto keys = table("none = 0\none = 1\nmost = 1000000000\nmore = 1000000001\n");
  CHECK(count_or(*keys, "one", 7) == 1);
  CHECK(count_or(*keys, "most", 7) == 1'000'000'000);
  CHECK(count_or(*keys, "absent", 7) == 7);
  CHECK_THROWS_WITH(count_or(*keys, "none", 7),
                    "some.toml:2: 'none' must lie in 1 .. 1,000,000,000");
  CHECK_THROWS_WITH(count_or(*keys, "more", 7),
                    "some.toml:5: 'more' must lie in 1 .. 1,000,000,000");
}

TEST_CASE("as many triangles as the limit are made, and one more is refused", "[scene]") {
  const auto keys = table("rows = 12\n");
  CHECK_NOTHROW(reject_many_triangles(*keys, "rows", 12345, {12345, 3}));
  CHECK_THROWS_WITH(reject_many_triangles(*keys, "rows", 12346, {12345, 3}),
                    "some.toml:2: 'rows' asks for 1.235e+04 triangles; 1.234e+04 at most are made");
  CHECK(SceneLimits{}.triangles == 1e7);
  CHECK(SceneLimits{}.frames == 1000);
}

TEST_CASE("the first choice is the default, and others are refused with all that are known",
          "[scene]") {
  const auto keys = table("kind = \"c\"\nwrong = \"d\"\n");
  const std::vector<std::pair<std::string, int>> choices = {{"a", 11}, {"b", 22}, {"c", 33}};
  CHECK(choice<int>(*keys, "kind", choices) == 33);
  CHECK(choice<int>(*keys, "absent", choices) == 11);
  CHECK_THROWS_WITH(choice<int>(*keys, "wrong", choices),
                    "some.toml:3: unknown wrong 'd'; known: a, b, c");
}

TEST_CASE("an error without a place gets one, and others keep theirs", "[scene]") {
  const auto said = [](const std::string& message) {
    try {
      return with_error_location("some.toml:7",
                                 [&]() -> std::string { throw InputError(message); });
    } catch (const InputError& error) {
      return std::string(error.what());
    }
  };
  CHECK(said("radius is 0") == "some.toml:7: radius is 0");
  CHECK(said("some.toml:9: radius is 0") == "some.toml:9: radius is 0");
  CHECK(said("--set a=0: radius is 0") == "--set a=0: radius is 0");
  CHECK(with_error_location("some.toml:7", [] { return 42; }) == 42);
}

TEST_CASE("each key of a motion goes to its place, angles in degrees", "[scene]") {
  const Motion m = read_motion(
      *table("velocity = [0.3, -0.7, 1.1]\namplitude = [0.02, 0.05, -0.08]\nfrequency = 2.5\n"
             "phase = 30\ncenter = [4, 5, -6]\nangular_velocity = [90, -45, 18]\nfrom = 0.25\n"
             "until = 3.5\n"));
  CHECK(m.velocity == Vector3(0.3, -0.7, 1.1));
  CHECK(m.amplitude == Vector3(0.02, 0.05, -0.08));
  CHECK(m.frequency == 2.5);
  CHECK(m.phase == Approx(pi / 6).epsilon(1e-15));
  CHECK(m.center == Vector3(4, 5, -6));
  CHECK((m.angular_velocity - Vector3(pi / 2, -pi / 4, pi / 10)).norm() < 1e-15);
  CHECK(m.from == 0.25);
  CHECK(m.until == 3.5);
}

TEST_CASE("a motion without keys is rest for ever", "[scene]") {
  const Motion m = read_motion(*table(""));
  CHECK(m.velocity == Vector3::Zero());
  CHECK(m.amplitude == Vector3::Zero());
  CHECK(m.frequency == 0);
  CHECK(m.phase == 0);
  CHECK(m.center == Vector3::Zero());
  CHECK(m.angular_velocity == Vector3::Zero());
  CHECK(m.from == 0);
  CHECK(m.until == std::numeric_limits<double>::infinity());
}

TEST_CASE("a motion starts at 0 or later, and stops later than that", "[scene]") {
  CHECK(read_motion(*table("from = 0\nuntil = 5e-324\n")).until == 5e-324);
  CHECK_THROWS_WITH(read_motion(*table("from = -5e-324\n")),
                    "some.toml:2: 'from' must be a time >= 0 s");
  CHECK_THROWS_WITH(read_motion(*table("from = 0.5\nuntil = 0.5\n")),
                    "some.toml:3: 'until' must be later than 'from', in s");
  CHECK_THROWS_WITH(read_motion(*table("until = 0\n")),
                    "some.toml:2: 'until' must be later than 'from', in s");
}

TEST_CASE("a turn is about its axis, whatever its length, in degrees", "[scene]") {
  const Eigen::AngleAxisd turn = read_turn(*table("turn = { axis = [0, -3, 4], angle = 72 }\n"));
  CHECK((turn.axis() - Vector3(0, -0.6, 0.8)).norm() < 1e-15);
  CHECK(turn.angle() == Approx(2 * pi / 5).epsilon(1e-15));
  CHECK(read_turn(*table("")).angle() == 0);
  CHECK(read_turn(*table("")).toRotationMatrix() == Eigen::Matrix3d::Identity());
  CHECK_THROWS_WITH(read_turn(*table("turn = { axis = [0, 0, 0], angle = 72 }\n")),
                    "some.toml:2: 'axis' must not be zero");
  CHECK_NOTHROW(read_turn(*table("turn = { axis = [0, 1e-9, 0], angle = 72 }\n")));
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
    CHECK_NOTHROW(reject_outside(inner + "/a.obj", folder, "w"));
    CHECK_NOTHROW(reject_outside(inner + "/below/a.obj", folder, "w"));
    CHECK_NOTHROW(reject_outside(inner + "/loop/a.obj", folder, "w"));
    CHECK_NOTHROW(reject_outside(inner, folder, "w"));
    CHECK_THROWS_WITH(reject_outside(beside + "/a.obj", folder, "w:3"),
                      "w:3: '" + beside + "/a.obj" + lies_outside);
    CHECK_THROWS_WITH(reject_outside(inner + "/link/a.obj", folder, "w"), EndsWith(lies_outside));
    CHECK_THROWS_WITH(reject_outside(scratch.file("a.obj"), folder, "w"), EndsWith(lies_outside));
  }
  const std::string absent = scratch.file("absent");
  CHECK_NOTHROW(reject_outside(absent + "/a.obj", absent + "/", "w"));
  CHECK_NOTHROW(reject_outside("a.obj", "", "w"));
  CHECK_NOTHROW(reject_outside("below/a.obj", "", "w"));
  CHECK_THROWS_WITH(reject_outside("../a.obj", "", "w"), "w: '../a.obj" + lies_outside);
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
  CHECK_THROWS_WITH(path("../a.obj"), "some.toml:3: '../a.obj" + leaves);
  CHECK_THROWS_WITH(path("below/../a.obj"), "some.toml:3: 'below/../a.obj" + leaves);
  CHECK_THROWS_WITH(path("below/.."), "some.toml:3: 'below/.." + leaves);
  CHECK_THROWS_WITH(path(folder + "a.obj"), Contains(leaves));
  std::filesystem::create_directory_symlink(std::filesystem::temp_directory_path(),
                                            scratch.file("link"));
  CHECK_THROWS_WITH(path("link/a.obj"),
                    "some.toml:3: '" + scratch.file("link/a.obj") + lies_outside);
  const auto keys = table("mesh = \"b.obj\"\n");
  set_key(*keys, "mesh=../a.obj");
  CHECK(path_of(*keys, "mesh", folder) == "../a.obj");
  set_key(*keys, "mesh=/a.obj");
  CHECK(path_of(*keys, "mesh", folder) == "/a.obj");
}
