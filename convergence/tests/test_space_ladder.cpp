// Ladders of meshes, and the study of a ladder.
#include <catch2/catch.hpp>

#include "convergence/any_case/converge.h"
#include "convergence/any_case/solver_ladder.h"
#include "convergence/any_case/space_ladder.h"
#include "verification/specimens/scratch_folder.h"

using namespace foldproof;

namespace {

const std::string physics =
    "\n[gravity]\n[stretch]\nstiffness = 40\n[bending]\nstiffness = 1e-3\n[time]\nend = 0.04\n"
    "frames_per_second = 50\n";

std::string sheet_of(const std::string& pattern, const std::string& more = "") {
  return "[cloth]\nshape = \"sheet\"\npattern = \"" + pattern +
         "\"\nwidth = 0.3\nheight = 0.2\ncolumns = 3\nrows = 4\ndensity = 0.2\n" + more + physics;
}

SpaceLadder ladder_of(const std::string& text, int levels = 3, ObjectsToo too = ObjectsToo::no,
                      const std::vector<std::string>& overrides = {}) {
  static const ScratchFolder folder;
  return space_ladder({folder.write("case.toml", text), overrides, "", 0}, levels, too);
}

const Scene& scene_of(const SpaceLadder& ladder, int level) {
  return ladder.levels[size_t(level)].input_case.scene;
}

bool warns_of(const std::vector<std::string>& warnings, const std::string& words) {
  return std::ranges::any_of(warnings,
                             [&](const std::string& w) { return w.find(words) != w.npos; });
}

/// Level 0's particles are where they are on every mesh, at rest and at the start.
void require_common_particles(const SpaceLadder& ladder, const std::string& refined_by) {
  CHECK(ladder.refined_by.starts_with(refined_by));
  const Scene& first = scene_of(ladder, 0);
  for (const SpaceLevel& level : ladder.levels) {
    const Scene& scene = level.input_case.scene;
    REQUIRE(level.common.size() == size_t(first.x.cols()));
    CHECK((scene.mesh.rest(Eigen::all, level.common) - first.mesh.rest).norm() < 1e-12);
    CHECK((scene.x(Eigen::all, level.common) - first.x).norm() < 1e-12);
  }
}

const std::string corner =
    "[[quantity]]\nname = \"corner\"\nwhat = \"position\"\nof = { particles = [19] }\n";

}  // namespace

TEST_CASE("shapes are refined by their numbers where particles stay") {
  for (const std::string pattern :
       {"one_diagonal", "alternating", "union_jack", "criss_cross", "equilateral"}) {
    const SpaceLadder ladder = ladder_of(sheet_of(pattern));
    require_common_particles(ladder, "columns, rows");
    // the half triangles at the border of an equilateral sheet are fewer on a finer one
    const double border = pattern == "equilateral" ? 0.08 : 1e-12;
    CHECK(ladder.levels[2].edge == Approx(ladder.levels[0].edge / 4).epsilon(border));
  }
  for (const auto& [shape, numbers] : std::vector<std::pair<std::string, std::string>>{
           {"disc\"\nrings = 3\n", "rings"},
           {"cylinder\"\nheight = 0.4\naround = 7\nalong = 3\n", "a"},
           {"sphere\"\ndivisions = 3\n", "divisions"},
           {"sphere\"\nsubdivisions = 1\n", "subdivisions"}})
    require_common_particles(
        ladder_of("[cloth]\nradius = 0.3\ndensity = 0.2\nshape = \"" + shape + physics), numbers);
}

TEST_CASE("irregular and graded sheets are refined by the middles of edges") {
  std::string bent = sheet_of("alternating");
  bent.replace(bent.find("stiffness = 1e-3"), 16, "stiffness = 1e-3\nrest_angle = 20");
  for (const std::string& text :
       {sheet_of("jittered", "jitter = 0.2\n"), sheet_of("random_delaunay"),
        sheet_of("union_jack", "grading = 3\n"), sheet_of("alternating", "refine = 1\n"), bent,
        "[cloth]\nshape = \"hinge\"\nlength = 0.1\nangle = 30\ndensity = 0.2\n" + physics}) {
    const SpaceLadder ladder = ladder_of(text);
    require_common_particles(ladder, "middles of edges, since ");
    CHECK(scene_of(ladder, 1).mesh.triangles.size() ==
          4 * scene_of(ladder, 0).mesh.triangles.size());
  }
}

TEST_CASE("the noise of a start stays that of the case's own particles") {
  require_common_particles(ladder_of(sheet_of("alternating") + "[start]\nnoise = 0.001\n"),
                           "middles of edges, since the noise of the start goes by particle");
}

TEST_CASE("a start about another centre is refined by the middles of edges") {
  // the stretch is about the mean of all particles, which on a folded sheet moves with the mesh
  require_common_particles(
      ladder_of(sheet_of("alternating") + "[start]\nfolded = { layers = 2, gap = 0.02, dip = 0.01, "
                                          "along = [1, 0, 0], up = [0, 0, 1] }\nstretch = 1.1\n"),
      "middles of edges, since finer meshes of this shape lack particles of the case");
}

TEST_CASE("boxes hold regions, lists of particles hold points") {
  const SpaceLadder boxed =
      ladder_of(sheet_of("alternating") + "[[hold]]\nbox = [[-1, 0.19, -1], [1, 1, 1]]\n");
  for (int k = 0; k < 3; ++k) CHECK(scene_of(boxed, k).prescribed.size() == (3U << k) + 1);
  CHECK_FALSE(warns_of(boxed.warnings, "held at points"));
  const SpaceLadder listed =
      ladder_of(sheet_of("alternating") + "[[hold]]\nparticles = [16, 17, 19]\n");
  CHECK(warns_of(listed.warnings, "held at points"));
  for (int k = 0; k < 3; ++k)
    for (size_t i = 0; i < 3; ++i)
      CHECK((scene_of(listed, k).prescribed.at(i).start - scene_of(listed, 0).prescribed[i].start)
                .norm() < 1e-12);
}

TEST_CASE("measured particles are the same points on every mesh") {
  const SpaceLadder ladder = ladder_of(sheet_of("one_diagonal") + corner);
  for (const SpaceLevel& level : ladder.levels) {
    const Scene& scene = level.input_case.scene;
    const std::vector<int> of = particles_in(level.input_case.quantities[0].of, scene);
    CHECK((scene.x(Eigen::all, of) - Vector3(0.3, 0.2, 0)).norm() < 1e-12);
  }
}

TEST_CASE("sticky triangles and groups become their quarters") {
  const SpaceLadder ladder = ladder_of(
      sheet_of("alternating") +
      "[[sticky]]\nsurface = { of = \"cloth\", triangles = [2, 5] }\nparticles = { particles = "
      "[0, 3] }\nstiffness = 1\nforecast_time = 0.01\nnear = 0.01\nfar = 0.02\n");
  require_common_particles(ladder, "middles of edges, since what is sticky is listed by triangles");
  double area[3] = {};
  for (const int k : {0, 2})
    for (const Triangle& t : scene_of(ladder, k).sticky[0].triangles) {
      const PerParticle3& x = scene_of(ladder, k).x;
      area[k] += (x.col(t[1]) - x.col(t[0])).cross(x.col(t[2]) - x.col(t[0])).norm() / 2;
    }
  CHECK(area[2] == Approx(area[0]).epsilon(1e-12));
  CHECK(scene_of(ladder, 2).sticky[0].triangles.size() == 32);
  CHECK(scene_of(ladder, 2).sticky[0].particles == std::vector<int>{0, 3});
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
  const SpaceLadder ladder =
      ladder_of(sheet_of("alternating"), 4, ObjectsToo::no, {"time.step=0.008"});
  CHECK(space_level(ladder, 3, {}).input_case.scene.schedule.step.fixed == 0.001);
  CHECK(warns_of(ladder.warnings, "divided by 8"));
  const std::vector<double> ends = {0.01, 0.03}, halves = {0.005, 0.01, 0.02, 0.03};
  CHECK(space_level(ladder, 0, ends).input_case.scene.schedule.step.ends == ends);
  const Scene check = step_check_level(ladder, ends).input_case.scene;
  CHECK_THAT(check.schedule.step.ends, Catch::Approx(halves).margin(1e-15));
  CHECK(check.mesh.particles() == scene_of(ladder, 2).mesh.particles());
}

TEST_CASE("level sets are refined only when that is asked") {
  for (const ObjectsToo objects : {ObjectsToo::no, ObjectsToo::yes}) {
    const SpaceLadder ladder =
        ladder_of(sheet_of("alternating") +
                      "[[object]]\nshape = \"statue\"\nheight = 1\ncells = 20\nmove = [0, -3, 0]\n"
                      "[[object]]\nshape = \"sphere\"\nradius = 0.1\nmove = [0, -3, 0]\n",
                  3, objects);
    CHECK(warns_of(ladder.levels[2].overrides, "cells") == (objects == ObjectsToo::yes));
    CHECK(warns_of(ladder.levels[2].overrides, "object.0.cells=80") ==
          (objects == ObjectsToo::yes));
  }
}

TEST_CASE("a ladder in space is read with the order two, and its steps' error beside it") {
  const SpaceLadder ladder = ladder_of(sheet_of("one_diagonal") + corner, 4);
  std::vector<LevelRun> runs(4);  // errors 0.3 4^-k of the limit 1
  for (size_t k = 0; k < 4; ++k) {
    runs[k].values = {1 + 0.3 * std::pow(0.25, k)};
    runs[k].times = {0};
    runs[k].x = {PerParticle3::Constant(3, 20, runs[k].values[0])};
  }
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
  halved.values[0] += 3e-3;  // now more than a tenth of the last difference
  CHECK(warns_of(space_answer(ladder, runs, halved).warnings, "corner: the steps' own error"));
  runs[1].stopped = "a particle left";
  CHECK(std::isnan(space_answer(ladder, runs, halved).quantities[1].bar.order));
}

TEST_CASE("runs keep the places of the case's own particles") {
  const SpaceLadder ladder = ladder_of(sheet_of("alternating"));
  Level level = space_level(ladder, 1, {});
  const LevelRun run = run_level(level, computing_provider());
  REQUIRE(run.x.front().cols() == 20);
  CHECK((run.x.front() - scene_of(ladder, 0).x).norm() < 1e-12);
  level.common.pop_back();
  CHECK(key_of(level, "p") != key_of(space_level(ladder, 1, {}), "p"));
}

using Catch::Matchers::Contains;

namespace {

QuantityOverLevels quantity_of(const std::string& name, const std::vector<double>& differences) {
  return {name, "m", {}, differences, error_bar({{}, differences, 2, 2, 0}), 0.5};
}

LadderAnswer answer_of(std::vector<QuantityOverLevels> quantities) {
  const std::vector<double> sizes = {0.08, 0.04, 0.02, 0.01};
  LadderAnswer answer{"strip",
                      "C",
                      "time",
                      sizes,
                      {1, 2, 4, 8},
                      {3, 6, 12, 24},
                      {"", "", "", "fell"},
                      std::move(quantities),
                      {4, 4, 4, 4}};
  answer.formal_order = 2;
  return answer;
}

}  // namespace

TEST_CASE("the asymptotic range reaches back as long as orders agree") {
  const auto M = Mark::measured, U = Mark::unfinished;
  // orders 1, 2, 2
  CHECK(range_marks(quantity_of("x", {2, 1, 0.25, 0.0625})) == std::vector<Mark>{U, M, M, M});
  CHECK(range_marks(quantity_of("x", {16, 4, 1, 0.25})) == std::vector<Mark>{M, M, M, M});
  CHECK(range_marks(quantity_of("x", {4, 1, 0.5})) == std::vector<Mark>{U, U, U});
  CHECK(range_marks(quantity_of("x", {1, 2, 4})) == std::vector<Mark>{U, U, U});
}

TEST_CASE("an error is halved by its order, or by a level, or in no known way") {
  LadderAnswer settled = answer_of({quantity_of("positions", {16, 4, 1})});  // work doubles a level
  CHECK(how_to_halve(settled) ==
        "Steps 1.41 times shorter (0.057 s) halve that error, at 1.4 times the work.");
  settled.in = "space";
  settled.particles = {4, 8, 16, 32};
  CHECK(how_to_halve(settled) ==
        "Edges 1.41 times shorter (0.057 m) halve that error, at 2.0 times the work.");
  // the levels' errors, each its distance to the finest and that one's bar of 6: 28, 12, 8, 6
  LadderAnswer unsettled = answer_of({quantity_of("positions", {16, 4, 2})});
  unsettled.quantities[0].bar.half_width = 6;
  for (const auto& [error, words] : std::map<double, std::string>{
           {28, "Steps 2 times shorter at least halve that error, at 2.0 times the work."},
           {23, "Steps 4 times shorter at least halve that error, at 4.0 times the work."},
           {11, "No level of this ladder halves that error."}}) {
    unsettled.quantities[0].first_error = error;
    CHECK(how_to_halve(unsettled) == words);
  }
  CHECK(how_to_halve(answer_of({quantity_of("positions", {1, 2, 4})})) ==
        "What halves that error is not known.");
}

TEST_CASE("two solvers are called different models by their error bars only") {
  CHECK_THAT(in_words(SolverGap{1, 0.2, 0.3, true}, "s"), Contains("the models differ"));
  CHECK_THAT(in_words(SolverGap{0.4, 0.2, 0.3, true}, "s"), Contains("steps may explain it"));
  CHECK_THAT(in_words(SolverGap{1, 0.2, 0.3, false}, "s"), Contains("nothing can be said"));
}
