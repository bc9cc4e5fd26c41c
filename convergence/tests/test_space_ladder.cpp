// `foldproof converge --in space`: finer meshes that are the same case, and what is read from them.
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <random>

#include "convergence/any_case/space_ladder.h"
#include "reference/forces/bending.h"
#include "reference/mesh/shapes.h"

using namespace foldproof;

namespace {

constexpr const char* physics = R"(
[gravity]
[stretch]
stiffness = 40
[bending]
stiffness = 1e-3
[time]
end = 0.04
frames_per_second = 50
)";

std::string sheet_of(const std::string& pattern, const std::string& more = "") {
  return "[cloth]\nshape = \"sheet\"\npattern = \"" + pattern +
         "\"\nwidth = 0.3\nheight = 0.2\ncolumns = 3\nrows = 4\ndensity = 0.2\n" + more + physics;
}

/// A case file in the system's temporary folder, another one for each process.
CaseSource source_of(const std::string& text) {
  static const unsigned process = std::random_device{}();
  const auto path = std::filesystem::temp_directory_path() /
                    ("foldproof_space_ladder_" + std::to_string(process) + ".toml");
  std::ofstream(path) << text;
  return {path.string(), {}, "", 0};
}

SpaceLadder ladder_of(const std::string& text, int levels = 3) {
  return space_ladder(source_of(text), levels, ObjectsToo::no);
}

const Scene& scene_of(const SpaceLadder& ladder, int level) {
  return ladder.levels[size_t(level)].input_case.scene;
}

bool warns_of(const std::vector<std::string>& warnings, const std::string& words) {
  return std::ranges::any_of(warnings,
                             [&](const std::string& w) { return w.find(words) != w.npos; });
}

/// Level 0's particles are where they are on every mesh, at rest and at the start.
void require_common_particles(const SpaceLadder& ladder) {
  const Scene& first = scene_of(ladder, 0);
  for (const SpaceLevel& level : ladder.levels) {
    const Scene& scene = level.input_case.scene;
    REQUIRE(level.common.size() == size_t(first.x.cols()));
    CHECK((scene.mesh.rest(Eigen::all, level.common) - first.mesh.rest).norm() < 1e-12);
    CHECK((scene.x(Eigen::all, level.common) - first.x).norm() < 1e-12);
  }
}

}  // namespace

TEST_CASE("shapes are refined by their numbers where particles stay") {
  for (const char* pattern :
       {"one_diagonal", "alternating", "union_jack", "criss_cross", "equilateral"}) {
    const SpaceLadder ladder = ladder_of(sheet_of(pattern));
    CHECK(ladder.refined_by == "columns, rows");
    require_common_particles(ladder);
    // the half triangles at the border of an equilateral sheet are fewer on a finer one
    const double border = std::string(pattern) == "equilateral" ? 0.08 : 1e-12;
    CHECK(ladder.levels[2].edge == Approx(ladder.levels[0].edge / 4).epsilon(border));
  }
  const std::string round = "density = 0.2\nradius = 0.3\n" + std::string(physics);
  for (const std::string shape :
       {"disc\"\nrings = 3\n", "cylinder\"\nheight = 0.4\naround = 7\nalong = 3\n",
        "sphere\"\ndivisions = 3\n", "sphere\"\nsubdivisions = 1\n"}) {
    const SpaceLadder ladder = ladder_of("[cloth]\nshape = \"" + shape + round);
    CHECK(ladder.refined_by.find("middles") == std::string::npos);
    require_common_particles(ladder);
  }
}

TEST_CASE("irregular and graded sheets are refined by the middles of edges") {
  for (const std::string& text :
       {sheet_of("jittered", "jitter = 0.2\n"), sheet_of("random_delaunay"),
        sheet_of("union_jack", "grading = 3\n"), sheet_of("alternating", "refine = 1\n"),
        "[cloth]\nshape = \"hinge\"\nlength = 0.1\nangle = 30\ndensity = 0.2\n" +
            std::string(physics)}) {
    const SpaceLadder ladder = ladder_of(text);
    CHECK(ladder.refined_by.starts_with("middles of edges, since "));
    require_common_particles(ladder);
    CHECK(scene_of(ladder, 1).mesh.triangles.size() ==
          4 * scene_of(ladder, 0).mesh.triangles.size());
  }
}

TEST_CASE("the noise of a start stays that of the case's own particles") {
  const SpaceLadder ladder = ladder_of(sheet_of("alternating") + "[start]\nnoise = 0.001\n");
  CHECK(ladder.refined_by == "middles of edges, since the noise of the start goes by particle");
  require_common_particles(ladder);
}

TEST_CASE("a start about another centre is refined by the middles of edges") {
  // the stretch is about the mean of all particles, which on a folded sheet moves with the mesh
  const SpaceLadder ladder = ladder_of(sheet_of("alternating") +
                                       "[start]\nfolded = { layers = 2, gap = 0.02, dip = 0.01, "
                                       "along = [1, 0, 0], up = [0, 0, 1] }\nstretch = 1.1\n");
  CHECK(ladder.refined_by ==
        "middles of edges, since finer meshes of this shape lack particles of the case");
  require_common_particles(ladder);
}

TEST_CASE("one rest angle for all hinges bends a finer mesh no more") {
  std::string text = sheet_of("alternating");
  text.replace(text.find("stiffness = 1e-3"), 16, "stiffness = 1e-3\nrest_angle = 20");
  const SpaceLadder ladder = ladder_of(text);
  CHECK(ladder.refined_by == "middles of edges, since one rest angle is given for all hinges");
  double bent[2] = {0, 0};  // angle times length: the same on halves
  for (int k = 0; k < 2; ++k)
    for (size_t h = 0; h < scene_of(ladder, k).rest_angles.size(); ++h) {
      const Hinge& hinge = scene_of(ladder, k).mesh.hinges[h];
      const PerParticle3& rest = scene_of(ladder, k).mesh.rest;
      bent[k] += scene_of(ladder, k).rest_angles[h] *
                 (rest.col(hinge.particles[3]) - rest.col(hinge.particles[2])).norm();
    }
  CHECK(bent[1] == Approx(bent[0]).epsilon(1e-12));
}

TEST_CASE("boxes hold regions, lists of particles hold points") {
  const SpaceLadder boxed =
      ladder_of(sheet_of("alternating") + "[[hold]]\nbox = [[-1, 0.19, -1], [1, 1, 1]]\n");
  CHECK(scene_of(boxed, 0).prescribed.size() == 4);
  CHECK(scene_of(boxed, 1).prescribed.size() == 7);
  CHECK(scene_of(boxed, 2).prescribed.size() == 13);
  CHECK_FALSE(warns_of(boxed.warnings, "held at points"));

  const SpaceLadder listed =
      ladder_of(sheet_of("alternating") + "[[hold]]\nparticles = [16, 17, 19]\n");
  CHECK(warns_of(listed.warnings, "held at points"));
  for (const SpaceLevel& level : listed.levels) {
    const auto& held = level.input_case.scene.prescribed;
    REQUIRE(held.size() == 3);
    for (size_t k = 0; k < 3; ++k)
      CHECK((held[k].start - scene_of(listed, 0).prescribed[k].start).norm() < 1e-12);
  }
}

TEST_CASE("measured particles are the same points on every mesh") {
  const SpaceLadder ladder = ladder_of(
      sheet_of("one_diagonal") +
      "[[quantity]]\nname = \"corner\"\nwhat = \"position\"\nof = { particles = [19] }\n");
  for (const SpaceLevel& level : ladder.levels) {
    const Scene& scene = level.input_case.scene;
    const std::vector<int> of = particles_in(level.input_case.quantities[0].of, scene);
    REQUIRE(of.size() == 1);
    CHECK((scene.x.col(of[0]) - Vector3(0.3, 0.2, 0)).norm() < 1e-12);
  }
}

TEST_CASE("sticky triangles and groups become their quarters") {
  const std::string patch =
      "[[sticky]]\nsurface = { of = \"cloth\", triangles = [2, 5] }\n"
      "particles = { particles = [0, 3] }\nstiffness = 1\nforecast_time = 0.01\n"
      "near = 0.01\nfar = 0.02\n";
  const SpaceLadder ladder = ladder_of(sheet_of("alternating") + patch);
  CHECK(ladder.refined_by == "middles of edges, since what is sticky is listed by triangles");
  const auto area = [&](int level) {
    const Scene& scene = scene_of(ladder, level);
    double sum = 0;
    for (const Triangle& t : scene.sticky[0].triangles) {
      const Vector3 a = scene.x.col(t[1]) - scene.x.col(t[0]),
                    b = scene.x.col(t[2]) - scene.x.col(t[0]);
      sum += a.cross(b).norm() / 2;
    }
    return sum;
  };
  CHECK(scene_of(ladder, 2).sticky[0].triangles.size() == 32);
  CHECK(area(2) == Approx(area(0)).epsilon(1e-12));
  CHECK(scene_of(ladder, 2).sticky[0].particles == std::vector<int>{0, 3});
  CHECK(warns_of(ladder.warnings, "sticking"));
}

TEST_CASE("a thickness too large for finer triangles becomes what they allow") {
  const SpaceLadder ladder =
      ladder_of(sheet_of("one_diagonal") + "[self_collision]\nthickness = 0.015\n");
  for (int k = 0; k < 3; ++k) {
    const Scene& scene = scene_of(ladder, k);
    CHECK(scene.self_collision->thickness ==
          Approx(std::min(0.015, 0.49 * smallest_height(scene.mesh.triangles, scene.mesh.rest))));
  }
  CHECK(warns_of(ladder.warnings, "thickness of self-collision falls"));
}

TEST_CASE("points match by place, and only where there is exactly one") {
  PerParticle3 among(3, 4);
  among << 0, 1, 2, 2, 0, 0, 5, 5, 0, 3, 1, 1;
  CHECK(matching_points(among.leftCols(2), among, 1e-9) == std::vector<int>{0, 1});
  CHECK(matching_points(among.rightCols(1), among, 1e-9).empty());  // twice there
  CHECK(matching_points(Vector3(0, 0, 1e-6), among, 1e-9).empty());
  PerParticle3 swapped = among(Eigen::all, std::vector<int>{2, 1, 0});
  CHECK(matching_points(among.leftCols(2), swapped, 1e-9) == std::vector<int>{2, 1});
}

TEST_CASE("all meshes take the steps of the finest, a fixed step divided") {
  CaseSource source = source_of(sheet_of("alternating"));
  source.overrides = {"time.step=0.008"};
  const SpaceLadder ladder = space_ladder(source, 4, ObjectsToo::no);
  CHECK(space_level(ladder, 3, {}).input_case.scene.schedule.step.fixed == 0.001);
  CHECK(warns_of(ladder.warnings, "divided by 8"));
  const std::vector<double> ends = {0.01, 0.03};
  CHECK(space_level(ladder, 0, ends).input_case.scene.schedule.step.ends == ends);
  const Level check = step_check_level(ladder, ends);
  const std::vector<double> halves = {0.005, 0.01, 0.02, 0.03};
  CHECK_THAT(check.input_case.scene.schedule.step.ends, Catch::Approx(halves).margin(1e-15));
  CHECK(check.input_case.scene.mesh.particles() == scene_of(ladder, 2).mesh.particles());
}

TEST_CASE("level sets are refined only when that is asked") {
  const std::string text = sheet_of("alternating") +
                           "[[object]]\nshape = \"statue\"\nheight = 1\ncells = 20\n"
                           "move = [0, -3, 0]\n[[object]]\nshape = \"sphere\"\nradius = 0.1\n"
                           "move = [0, -3, 0]\n";
  const auto cells = [&](ObjectsToo objects) {
    std::string all;
    const SpaceLadder ladder = space_ladder(source_of(text), 3, objects);
    for (const std::string& set : ladder.levels[2].overrides)
      if (set.find("cells") != set.npos) all += set;
    return all;
  };
  CHECK(cells(ObjectsToo::no).empty());
  CHECK(cells(ObjectsToo::yes) == "object.0.cells=80");
}

namespace {

/// Runs of a value and of one particle's place, errors c 4^-k of the limit 1.
std::vector<LevelRun> runs_with_errors(double c, int levels) {
  std::vector<LevelRun> runs;
  for (int k = 0; k < levels; ++k) {
    LevelRun run;
    const double value = 1 + c * std::pow(0.25, k);
    run.values = {value};
    run.times = {0};
    run.x = {PerParticle3::Constant(3, 20, value)};
    run.step_ends = {0.01, 0.02};
    run.work = 100;
    runs.push_back(run);
  }
  return runs;
}

const std::string measured =
    "[[quantity]]\nname = \"corner\"\nwhat = \"position\"\nof = { particles = [19] }\n";

}  // namespace

TEST_CASE("a ladder in space is read with the order two, and its steps' error beside it") {
  const SpaceLadder ladder = ladder_of(sheet_of("one_diagonal") + measured, 4);
  const std::vector<LevelRun> runs = runs_with_errors(0.3, 4);
  LevelRun halved = runs[2];
  halved.values[0] += 3e-5;
  halved.x[0].array() += 3e-5;
  const LadderAnswer answer = space_answer(ladder, runs, halved);
  REQUIRE(answer.quantities.size() == 2);
  for (const QuantityOverLevels& q : answer.quantities) {
    CHECK(q.bar.reading == Reading::asymptotic);
    CHECK(q.bar.order == Approx(2));
  }
  CHECK(answer.quantities[1].bar.limit == Approx(1).epsilon(1e-12));
  CHECK(answer.quantities[1].step_error == Approx(4e-5));  // of second order: 4/3 of the change
  CHECK(answer.quantities[0].step_error == Approx(4e-5 * std::sqrt(3)));
  CHECK_FALSE(warns_of(answer.warnings, "own error"));
  CHECK(answer.cost(3) == Approx(100.0 * scene_of(ladder, 3).mesh.particles()));
  CHECK(answer.particles[0] == 20);

  halved.values[0] += 3e-3;  // now more than a tenth of the last difference
  CHECK(warns_of(space_answer(ladder, runs, halved).warnings, "corner: the steps' own error"));
}

TEST_CASE("a level that stopped leaves a ladder in space without an order") {
  const SpaceLadder ladder = ladder_of(sheet_of("one_diagonal") + measured);
  std::vector<LevelRun> runs = runs_with_errors(0.3, 3);
  runs[1].stopped = "a particle left";
  const LadderAnswer answer = space_answer(ladder, runs, runs[1]);
  for (const QuantityOverLevels& q : answer.quantities) {
    CHECK(q.bar.reading == Reading::inconclusive);
    CHECK(std::isnan(q.bar.order));
  }
  CHECK(answer.stopped[1] == "a particle left");
}

TEST_CASE("runs keep the places of the case's own particles") {
  const SpaceLadder ladder = ladder_of(sheet_of("alternating") + measured);
  const LevelRun run = run_level(space_level(ladder, 1, {}), computing_provider());
  REQUIRE(run.stopped.empty());
  REQUIRE(run.x.front().cols() == 20);
  CHECK((run.x.front() - scene_of(ladder, 0).x).norm() < 1e-12);
  Level other = space_level(ladder, 1, {});
  other.common.pop_back();
  CHECK(key_of(other, "p") != key_of(space_level(ladder, 1, {}), "p"));
}
