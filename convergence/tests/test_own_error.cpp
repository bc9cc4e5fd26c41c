// A case's own error, as `foldproof ablate` compares with it, is that of the ladders of
// `foldproof converge`.
#include <catch2/catch.hpp>

#include "convergence/any_case/own_error.h"
#include "verification/specimens/scratch_folder.h"

using namespace foldproof;
using Catch::Matchers::Contains;

namespace {

/// A sheet held by an edge, which swings.
struct Asked {
  ScratchFolder folder;
  ResultStore store{folder.file("store")};
  CaseSource source{
      folder.write("swing.toml",
                   "[cloth]\nshape = \"sheet\"\nwidth = 0.3\nheight = 0.2\ncolumns = 3\nrows = 2\n"
                   "density = 0.2\n[stretch]\nstiffness = 40\ndamping = 0.01\n"
                   "[bending]\nstiffness = 1e-3\n[gravity]\nacceleration = [0, 0, -9]\n"
                   "[[hold]]\nbox = [[-1, -0.001, -1], [1, 0.001, 1]]\n"
                   "[solver]\ntolerance = 1e-11\n[time]\nend = 0.06\nframes_per_second = 100\n"),
      {},
      "",
      0};

  LevelSetProvider level_sets = computing_provider();

  KeptRuns by() { return {level_sets, store, "p"}; }
  LevelRun run(const Level& level) { return stored_level(level, by()); }
  LadderPlan plan() const { return {case_of(source), 3, measurements_of(case_of(source))}; }
  PerParticle mass() const {
    const Scene scene = case_of(source).scene;
    return lumped_masses(scene.mesh, scene.density);
  }
};

void require_of_ladder(const ErrorPart& error, const LadderAnswer& ladder) {
  const QuantityOverLevels positions = ladder.quantities.front();
  CHECK(error.unknown.empty());
  CHECK(error.value == positions.first_error);
  CHECK(error.seen == Approx(positions.differences[0] + positions.differences[1]).epsilon(1e-12));
}

}  // namespace

TEST_CASE(
    "a scene's own error in time is what a ladder of three levels says of the case as it is") {
  Asked asked;
  std::vector<LevelRun> runs = {asked.run(time_level(asked.plan(), 0, {}))};
  for (const int k : {1, 2})
    runs.push_back(asked.run(time_level(asked.plan(), k, runs[0].step_ends)));
  const ErrorPart error = error_of_steps(asked.source, asked.by());
  require_of_ladder(error, time_answer(asked.plan(), runs, 2));
}

TEST_CASE("of two meshes a scene's own error is their difference, and a spread as its bar") {
  Asked asked;
  const ErrorPart error = error_of_mesh(asked.source, 2, asked.by());
  const SpaceLadder ladder = space_ladder(asked.source, 2, ObjectsToo::no);
  const LevelRun finer = asked.run(space_level(ladder, 1, {}));
  const LevelRun own = asked.run(space_level(ladder, 0, finer.step_ends));
  CHECK(own.step_ends == finer.step_ends);
  CHECK(error.unknown.empty());
  CHECK(error.seen == field_difference(own, finer, asked.mass()));
  CHECK(error.seen > 0);
  CHECK(error.value == Approx(4 * error.seen).epsilon(1e-12));
}

TEST_CASE("of three meshes a scene's own error is what their ladder says of the case as it is") {
  Asked asked;
  const ErrorPart error = error_of_mesh(asked.source, 3, asked.by());
  const SpaceLadder ladder = space_ladder(asked.source, 3, ObjectsToo::no);
  std::vector<LevelRun> runs(3);
  runs[2] = asked.run(space_level(ladder, 2, {}));
  for (const int k : {0, 1}) runs[size_t(k)] = asked.run(space_level(ladder, k, runs[2].step_ends));
  const LevelRun halved = asked.run(step_check_level(ladder, runs[2].step_ends));
  require_of_ladder(error, space_answer(ladder, runs, halved));
  CHECK(asked.store.starts(key_of(space_level(ladder, 2, {}), "p")) == 1);  // made once for both
}

TEST_CASE("a coarser mesh is run by its own steps, and compared with the case as it is") {
  Asked asked;
  asked.source.overrides = {"cloth.columns=6", "cloth.rows=4"};
  const std::vector<std::string> coarser = {"cloth.columns=3", "cloth.rows=2"};
  const ErrorPart error = error_from_coarser_mesh(asked.source, coarser, asked.by());
  const LevelRun own = asked.run(time_level(asked.plan(), 0, {}));
  const TriangleMesh mesh = case_of(asked.source).scene.mesh;
  asked.source.overrides = coarser;
  const LevelRun other = asked.run(time_level(asked.plan(), 0, {}));
  const double first_order = error_from_coarser(own, mesh, other, case_of(asked.source).scene.mesh);
  CHECK(first_order > 0);
  CHECK(error.seen == Approx(first_order / 3).epsilon(1e-12));  // of order 2: 2^2 - 1
  CHECK(error.value == Approx(3 * first_order).epsilon(1e-12));
}

TEST_CASE("an error whose runs come to no end is not known, and says why") {
  Asked asked;
  asked.source.overrides = {"time.max_steps=3"};
  for (const ErrorPart& error :
       {error_of_steps(asked.source, asked.by()), error_of_mesh(asked.source, 2, asked.by()),
        error_from_coarser_mesh(asked.source, {"cloth.columns=1", "cloth.rows=1"}, asked.by())}) {
    CHECK(std::isnan(error.value));
    CHECK_THAT(error.unknown, Contains("cap on the number of steps"));
  }
}

TEST_CASE("where only the third level comes to no end, the other two leave a spread") {
  Asked asked;
  const LevelRun first = asked.run(time_level(asked.plan(), 0, {}));
  const LevelRun second = asked.run(time_level(asked.plan(), 1, first.step_ends));
  asked.source.overrides = {"time.max_steps=" + std::to_string(3 * first.step_ends.size())};
  const ErrorPart error = error_of_steps(asked.source, asked.by());
  CHECK(error.value == Approx(4 * field_difference(first, second, asked.mass())).epsilon(1e-12));
  CHECK_THAT(error.unknown, Contains("with a quarter of the step: "));
}

TEST_CASE("a scene's own error is asked up to the ablation's end only") {
  Asked asked;
  asked.source.until = 0.03;
  const ErrorPart begun = error_of_steps(asked.source, asked.by());
  asked.source.until = 0;
  asked.source.overrides = {"time.end=0.03"};
  CHECK(begun.value == error_of_steps(asked.source, asked.by()).value);
}
