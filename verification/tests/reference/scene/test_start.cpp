// Changes to the cloth before time 0: folding; and finer triangles.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "verification/tests/reference/scene/scene_texts.h"

using namespace foldproof;
using Catch::Matchers::Contains;

namespace {

/// A strip of 2 m along x from (3, 5, 7), 0.4 m wide along y.
Scene strip(const std::string& folded, const std::string& more = "") {
  return scene_of_cloth(
      "shape = \"sheet\"\nwidth = 2\nheight = 0.4\ncolumns = 40\nrows = 2\nmove = [3, 5, 7]\n" +
      more + "[start]\nfolded = { " + folded + " }\n");
}

}  // namespace

TEST_CASE("one corner of a fold's end sinks, in proportion along its last run", "[scene]") {
  // along = y and up = z make across = x; turned, the strip lies along y
  const std::string turned = "turn = { axis = [0, 0, 1], angle = 90 }\n",
                    folded = "layers = 3, gap = 0.05, along = [0, 2, 0], up = [0, 0, 1]";
  const Scene plain = strip(folded, turned), dipped = strip(folded + ", dip = 0.03", turned);
  const double run = (2 - pi * 0.05) / 3, last = 2 * run + pi * 0.05;
  const double left = plain.mesh.rest.row(0).minCoeff(), begin = plain.mesh.rest.row(1).minCoeff();
  double deepest = 0;
  for (Eigen::Index i = 0; i < plain.x.cols(); ++i) {
    const double along = std::max(0.0, (plain.mesh.rest(1, i) - begin - last) / run);
    const double sinks = 0.03 * along * (plain.mesh.rest(0, i) - left) / 0.4;
    CHECK((plain.x.col(i) - dipped.x.col(i) - Vector3(0, 0, sinks)).norm() < 1e-12);
    deepest = std::max(deepest, sinks);
  }
  CHECK(deepest == Approx(0.03).epsilon(1e-12));
}

TEST_CASE("a fold of two layers ends above its begin, along x and up y by default", "[scene]") {
  const std::string turned = "turn = { axis = [1, 0, 0], angle = 90 }\n";
  const Scene plain = strip("layers = 2, gap = 0.05", turned);
  CHECK(plain.x ==
        strip("layers = 2, gap = 0.05, along = [2, 0, 0], up = [0, 3, 0], dip = 0", turned).x);
  const PerParticle3 ends = plain.x.col(40) - plain.x.col(0);
  CHECK((ends - Vector3(0, 0.05, 0)).norm() < 1e-12);
  CHECK(plain.x.row(1).maxCoeff() - plain.x.row(1).minCoeff() == Approx(0.05).epsilon(1e-12));
}

TEST_CASE("a cloth is refined 0 to 8 times", "[scene]") {
  const auto refined = [](const std::string& times, double most = 1e7) {
    return scene_of_cloth("shape = \"hinge\"\nlength = 1\nangle = 40\nrefine = " + times + "\n",
                          {most, 3});
  };
  CHECK(refined("0").mesh.triangles.size() == 2);
  CHECK(refined("1").mesh.triangles.size() == 8);
  CHECK(refined("3").mesh.triangles.size() == 128);
  const std::string must = "some.toml:6: 'refine' must lie in 0 .. 8";
  CHECK_THROWS_WITH(refined("-1"), must);
  CHECK_THROWS_WITH(refined("9", 1), must);
  CHECK_THROWS_WITH(refined("8", 1),
                    "some.toml:6: 'refine' asks for 1.311e+05 triangles; 1 at most are made");
}

TEST_CASE("refining keeps surfaces, velocities, and the angles at old edges", "[scene]") {
  const auto cloth = [](int times) {
    return scene_of_cloth(
        "shape = \"sheet\"\nwidth = 2\nheight = 1\ncolumns = 2\nrows = 1\nrefine = " +
        std::to_string(times) +
        "\npleats = { columns = 1, angle = 30, start_flat = true }\n[start]\n"
        "stretch = [1.5, 2, 1]\nspin = [10, 20, 40]\nvelocity = [1, 2, 4]\n[bending]\n"
        "stiffness = 3\n");
  };
  const Scene coarse = cloth(0), fine = cloth(1);
  REQUIRE(coarse.mesh.edges.size() == 9);
  REQUIRE(fine.x.cols() == 6 + 9);
  for (int i = 0; i < 6; ++i) {
    CHECK(fine.x.col(i) == coarse.x.col(i));
    CHECK(fine.v.col(i) == coarse.v.col(i));
    CHECK(fine.mesh.rest.col(i) == coarse.mesh.rest.col(i));
  }
  for (int e = 0; e < 9; ++e) {
    const auto [a, b, of] = coarse.mesh.edges[size_t(e)];
    const auto check_middle = [e, a = a, b = b](const PerParticle3& old, const PerParticle3& now) {
      CHECK((2 * now.col(6 + e) - old.col(a) - old.col(b)).norm() < 1e-14);
    };
    check_middle(coarse.x, fine.x);
    check_middle(coarse.v, fine.v);
    check_middle(coarse.mesh.rest, fine.mesh.rest);
  }
  // the fold's two halves take its angle
  REQUIRE(fine.rest_angles.size() == fine.mesh.hinges.size());
  int folded = 0;
  for (size_t h = 0; h < fine.rest_angles.size(); ++h) {
    const auto& [a, b, of] = fine.mesh.edges[size_t(fine.mesh.hinges[h].edge)];
    const double middle = fine.mesh.rest(0, 1);
    const bool on_fold = std::abs(fine.mesh.rest(0, a) - middle) < 1e-12 &&
                         std::abs(fine.mesh.rest(0, b) - middle) < 1e-12;
    CHECK(std::abs(fine.rest_angles[h]) == Approx(on_fold ? pi / 6 : 0).margin(1e-14));
    folded += on_fold;
  }
  CHECK(folded == 2);
}

TEST_CASE("layers nearer than the rounding of their places are refused at the start", "[scene]") {
  const auto read = [](const std::string& apart) {
    return read_scene_text(
        "[cloth]\ndensity = 0.2\nshape = \"sheet\"\nwidth = 0.3\nheight = 0.3\ncolumns = 6\n"
        "rows = 6\ncopies = { count = 2, move = [0.02, 0.02, " +
            apart + "] }\n[self_collision]\nthickness = 0.002\n[time]\nend = 0.7\n",
        "some.toml");
  };
  for (const char* near : {"1e-18", "1e-17", "1e-16"})
    CHECK_THROWS_WITH(read(near), Contains("some.toml:9: layers of the cloth touch at the start") &&
                                      Contains("nearer than 5.7e-16 m"));
  for (const char* apart : {"1e-15", "0.001"}) CHECK(read(apart).warnings.empty());
  CHECK(read("0").warnings.size() == 1);  // they cross, by the exact test, and are reported
}
