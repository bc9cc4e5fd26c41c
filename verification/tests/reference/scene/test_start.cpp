// Changes to the cloth before time 0: folding, stretch, motion and noise; and finer triangles.
#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "reference/mesh/shapes.h"
#include "verification/tests/reference/scene/scene_texts.h"

using namespace foldproof;
using Catch::Matchers::StartsWith;

namespace {

std::string refusal(const std::string& tables) {
  try {
    sheet_with(tables);
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

/// Where a serpentine of runs `run` long and `gap` apart is at the length s, along and up [m].
Eigen::Vector2d on_serpentine(double s, double run, double gap) {
  const double arc = pi * gap / 2;
  if (s <= run) return {s, 0};
  s -= run;
  if (s <= arc)
    return {run + gap / 2 * std::sin(s / (gap / 2)), gap / 2 * (1 - std::cos(s / (gap / 2)))};
  s -= arc;
  if (s <= run) return {run - s, gap};
  s -= run;
  if (s <= arc)
    return {-gap / 2 * std::sin(s / (gap / 2)), gap + gap / 2 * (1 - std::cos(s / (gap / 2)))};
  return {s - arc, 2 * gap};
}

/// A strip of 2 m along x from (3, 5, 7), 0.4 m wide along y.
Scene strip(const std::string& folded, const std::string& more = "") {
  return scene_of_cloth(
      "shape = \"sheet\"\nwidth = 2\nheight = 0.4\ncolumns = 40\nrows = 2\nmove = [3, 5, 7]\n" +
      more + "[start]\nfolded = { " + folded + " }\n");
}

/// Of a strip with this key of its fold.
std::string fold_refusal(const std::string& folded, const std::string& more = "") {
  try {
    strip(folded, more);
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

}  // namespace

TEST_CASE("a cloth lies in a serpentine of runs and half circles, its length kept", "[scene]") {
  for (const int layers : {2, 3}) {
    const double gap = 0.05, run = (2 - (layers - 1) * pi * gap / 2) / layers;
    const Scene scene =
        strip("layers = " + std::to_string(layers) + ", gap = 0.05, up = [0, 0, 3]");
    for (Eigen::Index i = 0; i < scene.x.cols(); ++i) {
      const Vector3 rest = scene.mesh.rest.col(i);
      const Eigen::Vector2d place = on_serpentine(rest.x() - 3, run, gap);
      CHECK((scene.x.col(i) - Vector3(3 + place[0], rest.y(), 7 + place[1])).norm() < 1e-12);
    }
    CHECK(scene.mesh.rest(2, 0) == 7);
  }
}

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

TEST_CASE("a fold is along x and up y unless its keys say otherwise", "[scene]") {
  const std::string turned = "turn = { axis = [1, 0, 0], angle = 90 }\n";
  const Scene plain = strip("layers = 2, gap = 0.05", turned);
  const Scene told =
      strip("layers = 2, gap = 0.05, along = [1, 0, 0], up = [0, 1, 0], dip = 0", turned);
  CHECK(plain.x == told.x);
  CHECK(plain.x.row(1).maxCoeff() - plain.x.row(1).minCoeff() == Approx(0.05).epsilon(1e-12));
}

TEST_CASE("a fold has 2 to 1000 layers, each longer than the gap", "[scene]") {
  const std::string up = ", up = [0, 0, 1]";
  const std::string many = "some.toml:10: 'layers' must lie in 2 .. 1000",
                    brief = "some.toml:10: the cloth is too short for so many layers with that gap";
  CHECK(fold_refusal("layers = 1, gap = 0.001" + up) == many);
  CHECK(fold_refusal("layers = 2, gap = 0.001" + up) == "none");
  CHECK(fold_refusal("layers = 1000, gap = 1e-6" + up) == "none");
  CHECK(fold_refusal("layers = 1001, gap = 1e-6" + up) == many);
  CHECK(fold_refusal("layers = 2, gap = 0" + up) == "some.toml:10: 'gap' must be > 0");
  // two layers: (2 - pi gap/2)/2 > gap
  const double most = 2 / (2 + pi / 2);
  CHECK(fold_refusal("layers = 2, gap = " + std::to_string(most - 2e-6) + up) == "none");
  CHECK(fold_refusal("layers = 2, gap = " + std::to_string(most + 2e-6) + up) == brief);
}

TEST_CASE("a fold's directions are square to each other, and its cloth lies flat", "[scene]") {
  const std::string
      fold = "layers = 2, gap = 0.05",
      square = "some.toml:10: 'up' must be square to 'along', and both be directions",
      flat = "some.toml:10: the cloth must lie flat, square to 'up', before it is folded";
  CHECK(fold_refusal(fold + ", up = [0, 0, 1], along = [1, 0, 0.5e-9]") == "none");
  CHECK(fold_refusal(fold + ", up = [0, 0, 1], along = [1, 0, 1e-9]") == square);
  CHECK(fold_refusal(fold + ", up = [0, 0, 1], along = [1, 0, 2e-9]") == square);
  CHECK(fold_refusal(fold + ", up = [0, 0, 1], along = [1, 0, -2e-9]") == square);
  CHECK(fold_refusal(fold + ", up = [0, 0, 0]") == square);
  CHECK(fold_refusal(fold + ", up = [0, 0, 1], along = [0, 0, 0]") == square);
  CHECK(fold_refusal(fold) == flat);
  // 0.4 m wide, tilted by a part in a million of the length of 2 m, and less and more
  const auto tilted = [&](double angle) {
    return fold_refusal(fold + ", up = [0, 0, 1]",
                        "turn = { axis = [1, 0, 0], angle = " + std::to_string(angle) + " }\n");
  };
  const double most = 2e-6 / 0.4 * 180 / pi;
  std::string place = flat;
  CHECK(tilted(0.9 * most) == "none");
  CHECK(tilted(1.1 * most) == place.replace(10, 2, "11"));
}

TEST_CASE("a start is stretched about its middle, by one factor or three", "[scene]") {
  for (const bool one : {true, false}) {
    const Vector3 factors = one ? Vector3::Constant(1.5) : Vector3(1.5, 0.5, 3);
    const Scene scene =
        sheet_with("[start]\nstretch = " + std::string(one ? "1.5" : "[1.5, 0.5, 3]") + "\n");
    const Vector3 middle(2.375, 1, -1);
    for (Eigen::Index i = 0; i < scene.x.cols(); ++i) {
      const Vector3 arm = scene.mesh.rest.col(i) - middle;
      CHECK((scene.x.col(i) - middle - factors.cwiseProduct(arm)).norm() < 1e-14);
    }
  }
  CHECK((sheet_with("[start]\n").x - sheet_with("").x).norm() < 1e-14);
  CHECK(refusal("[start]\nstretch = 0\n") == "some.toml:11: 'stretch' must be > 0");
  for (const char* zero : {"[0, 1, 1]", "[1, 0, 1]", "[1, 1, 0]"})
    CHECK(refusal("[start]\nstretch = " + std::string(zero) + "\n") ==
          "some.toml:11: 'stretch' must be > 0");
}

TEST_CASE("a start drifts and spins about its middle, in degrees a second", "[scene]") {
  const Scene scene = sheet_with(
      "[start]\nstretch = 2\nvelocity = [0.1, 0.2, 0.4]\nspin = [18, -36, 90]\nnoise = 0.01\n");
  const Scene quiet = sheet_with("[start]\nstretch = 2\n");
  const Vector3 middle(2.375, 1, -1), spin(pi / 10, -pi / 5, pi / 2);
  for (Eigen::Index i = 0; i < scene.x.cols(); ++i) {
    const Vector3 arm = quiet.x.col(i) - middle;
    CHECK((scene.v.col(i) - Vector3(0.1, 0.2, 0.4) - spin.cross(arm)).norm() < 1e-14);
  }
  CHECK(sheet_with("[start]\n").v == PerParticle3::Zero(3, 20));
}

TEST_CASE("noise is uniform to either side, on each coordinate, by its seed", "[scene]") {
  const auto noise = [](const std::string& keys) {
    const std::string sheet =
        "shape = \"sheet\"\nwidth = 2\nheight = 3\ncolumns = 20\nrows = 30\n[start]\n";
    return PerParticle3((scene_of_cloth(sheet + keys).x - scene_of_cloth(sheet).x) / 0.01);
  };
  const PerParticle3 first = noise("noise = 0.01\n");
  for (int k = 0; k < 3; ++k) {
    CHECK(first.row(k).maxCoeff() < 1 + 1e-9);
    CHECK(first.row(k).maxCoeff() > 0.97);
    CHECK(first.row(k).minCoeff() > -1 - 1e-9);
    CHECK(first.row(k).minCoeff() < -0.97);
    // the mean of 651 of them has a deviation of 0.023, the mean square one of 0.012
    CHECK(std::abs(first.row(k).mean()) < 0.09);
    CHECK(first.row(k).squaredNorm() / 651 == Approx(1.0 / 3).margin(0.05));
  }
  CHECK(noise("noise = 0.01\nseed = 1\n") == first);
  CHECK((noise("noise = 0.01\nseed = 2\n") - first).norm() > 1);
  CHECK(noise("seed = 2\n").isZero(0));
  CHECK(noise("noise = 0\n").isZero(0));
  CHECK(refusal("[start]\nnoise = -1e-9\n") == "some.toml:11: 'noise' must not be negative");
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
    CHECK((2 * fine.x.col(6 + e) - coarse.x.col(a) - coarse.x.col(b)).norm() < 1e-14);
    CHECK((2 * fine.v.col(6 + e) - coarse.v.col(a) - coarse.v.col(b)).norm() < 1e-14);
    CHECK(
        (2 * fine.mesh.rest.col(6 + e) - coarse.mesh.rest.col(a) - coarse.mesh.rest.col(b)).norm() <
        1e-14);
  }
  // the fold's two halves
  REQUIRE(fine.rest_angles.size() == fine.mesh.hinges.size());
  int folded = 0;
  for (size_t h = 0; h < fine.rest_angles.size(); ++h) {
    const auto& [a, b, of] = fine.mesh.edges[size_t(fine.mesh.hinges[h].edge)];
    const bool on_fold = std::abs(fine.mesh.rest(0, a) - fine.mesh.rest(0, 1)) < 1e-12 &&
                         std::abs(fine.mesh.rest(0, b) - fine.mesh.rest(0, 1)) < 1e-12;
    CHECK(std::abs(fine.rest_angles[h]) == Approx(on_fold ? pi / 6 : 0).margin(1e-14));
    folded += on_fold;
  }
  CHECK(folded == 2);
}

TEST_CASE("each half of an old edge takes that edge's rest angle, new edges none", "[scene]") {
  const auto cloth = [](int times) {
    return scene_of_cloth(
        "shape = \"sheet\"\nwidth = 2\nheight = 1\ncolumns = 2\nrows = 1\nrefine = " +
        std::to_string(times) + "\n[bending]\nstiffness = 3\nrest_angle = 20\n");
  };
  const Scene fine = cloth(1);
  int bent = 0;
  for (const double angle : fine.rest_angles) {
    CHECK((angle == 0 || angle == 20 * (pi / 180)));
    bent += angle != 0;
  }
  CHECK(bent == 2 * int(cloth(0).rest_angles.size()));
  CHECK(fine.rest_angles.size() == size_t(bent) + 3 * 4);
  CHECK(scene_of_cloth("shape = \"hinge\"\nlength = 1\nangle = 40\nrefine = 1\n")
            .rest_angles.empty());
}
