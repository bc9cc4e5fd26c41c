// Levels of a ladder: their steps, their keys, their runs from a store, their cost.
#include <catch2/catch.hpp>
#include <set>

#include "convergence/any_case/converge.h"
#include "convergence/any_case/ladder_cost.h"
#include "convergence/work_precision/precision_problem.h"
#include "reference/scene/refine_cloth.h"
#include "verification/specimens/scratch_folder.h"

namespace foldproof {

using Catch::Matchers::Contains;

namespace {

LadderPlan trial(const std::vector<std::string>& overrides = {}) {
  const ScratchFolder folder;
  const std::string path =
      folder.write("trial.toml",
                   "[cloth]\nshape = \"sheet\"\nwidth = 0.3\nheight = 0.2\ncolumns = 3\nrows = 2\n"
                   "density = 0.2\n[stretch]\nstiffness = 40\ndamping = 0.01\n[gravity]\n[[hold]]\n"
                   "particles = [0, 3]\n[solver]\ntolerance = 1e-9\n[time]\nend = 0.03\n"
                   "frames_per_second = 100\n[[quantity]]\nwhat = \"lowest\"\n");
  LadderPlan plan{read_case(path, overrides), 4, {}};
  plan.measurements = measurements_of(plan.input_case);
  return plan;
}

/// The first level of the trial and a store.
struct Stored {
  ScratchFolder scratch;
  std::string folder = scratch.file("store");
  ResultStore store{folder};
  Level level = time_level(trial(), 0, {});
  std::string key = key_of(level, "p");

  LevelRun run() { return stored_level(level, {computing_provider(), store, "p"}); }
};

}  // namespace

TEST_CASE("counts have no rounding, and other values have") {
  const auto bar_of = [](const std::vector<double>& values) {
    std::vector<LevelRun> runs(values.size());
    for (size_t k = 0; k < values.size(); ++k) runs[k].values = {values[k]};
    return value_over_levels({"q", "lowest"}, 0, runs, 2).bar.half_width;
  };
  CHECK(bar_of({9, 9, 9, 9}) == 0);
  CHECK(bar_of({9, 8, 7, 7}) == 3);
  CHECK(bar_of({9.5, 9.5, 9.5, 9.5}) == Approx(9.5e3 * epsilon));
}

TEST_CASE("divided steps keep the ends of the undivided ones to the bit") {
  const std::vector<double> ends = {0.1, 0.1 + 1.0 / 3, 0.9};
  const std::vector<double> finer = divide_steps(ends, 0.04, 3);
  REQUIRE(finer.size() == 9);
  for (size_t k = 0; k < 3; ++k) CHECK(finer[3 * k + 2] == ends[k]);
  CHECK(finer[0] == Approx(0.06));
  CHECK(finer[1] == Approx(0.08));
  CHECK(finer[3] - finer[2] == Approx(1.0 / 9));
  CHECK(divide_steps({}, 0, 4).empty());
}

TEST_CASE("a finer level takes the steps of the coarser, each divided") {
  const LadderPlan plan = trial();
  const LevelRun first = run_level(time_level(plan, 0, {}), computing_provider());
  const LevelRun third = run_level(time_level(plan, 2, first.step_ends), computing_provider());
  CHECK(first.step_ends.back() == 0.03);
  CHECK(third.step_ends == divide_steps(first.step_ends, 0, 4));
  CHECK(third.times == first.times);
  CHECK(first.values == std::vector<double>{first.x.back().row(1).minCoeff()});
}

TEST_CASE("the key of a level changes with everything that its run depends on") {
  const Level plain = time_level(trial(), 0, {});
  std::set<std::string> keys = {
      key_of(plain, "program 1"), key_of(plain, "program 2"),
      key_of(time_level(trial({"stretch.stiffness=41"}), 0, {}), "program 1")};
  size_t different = 3;
  for (const std::function<void(Level&, Scene&)>&change :
       std::initializer_list<std::function<void(Level&, Scene&)>>{
           [](Level&, Scene&s) { s.integrator = "BDF2"; },
           [](Level&, Scene&s) { s.schedule.step.fixed = 1e-3; },
           [](Level&, Scene&s) { s.schedule.step.safety /= 2; },
           [](Level&, Scene&s) { s.schedule.step.strain_per_step /= 2; },
           [](Level&, Scene&s) {
             s.schedule.step.ends = {0.01, 0.02, 0.03};
           },
           [](Level&, Scene&s) { s.schedule.end = 0.02; },
           [](Level&, Scene&s) { s.schedule.frame_interval = 0.005; },
           [](Level&, Scene&s) { s.schedule.max_steps = 3; },
           [](Level&, Scene&s) { s.solver.tolerance = 1e-10; },
           [](Level&, Scene&s) { s.solver.max_iterations += 1; },
           [](Level&, Scene&s) { refine_cloth(s); },
           [](Level&, Scene&s) { s.x(0, 5) += 1e-15; },
           [](Level&, Scene&s) { s.v(0, 5) += 1e-15; },
           [](Level&, Scene&s) { s.text += "# "; },
           [](Level&l, Scene&) { l.particles -= 1; },
           [](Level&l, Scene&) { l.measurements[0].what = "highest"; },
           [](Level&l, Scene&) { l.measurements[0].of.particles = {3}; },
           [](Level&l, Scene&) {
             l.measurements[0].of.box = {{Vector3::Zero(), Vector3::Ones()}};
           },
           [](Level&l, Scene&) { l.measurements[0].when = Instant::maximum; },
           [](Level&l, Scene&) { l.measurements[0].time = 0.01; },
           [](Level&l, Scene&) { l.measurements[0].along = Vector3(1, 0, 0); },
           [](Level&l, Scene&) { l.measurements.push_back(l.measurements[0]); }}) {
    Level level = plain;
    change(level, level.input_case.scene);
    keys.insert(key_of(level, "program 1"));
    CHECK(keys.size() == ++different);
  }
}

TEST_CASE("a level is run once, and then read from the store bit for bit") {
  Stored stored;
  const LevelRun made = stored.run();
  ResultStore later(stored.folder);
  const LevelRun read = stored_level(stored.level, {computing_provider(), later, "p"});
  CHECK(read.x == made.x);
  CHECK(read.times == made.times);
  CHECK(read.values == made.values);
  CHECK(read.step_ends == made.step_ends);
  CHECK(operator_applications(read.work) == operator_applications(made.work));
  CHECK(read.steps == made.steps);
  CHECK(later.starts(stored.key) == 1);
}

TEST_CASE("a run that stopped is kept with its reason") {
  Stored stored;
  stored.level.input_case.scene.schedule.max_steps = 2;
  for (int k = 0; k < 2; ++k) {
    const LevelRun run = stored.run();
    CHECK_THAT(run.stopped, Contains("cap on the number of steps"));
    CHECK(std::isnan(run.values.at(0)));
    CHECK(std::isnan(field_difference(run, run, PerParticle::Ones(12))));
  }
}

TEST_CASE("a stored run that lacks something is made again") {
  for (const char* lacking : {"values", "times", "positions", "kinetic", "elastic", "contacts",
                              "work", "seconds", "stopped"}) {
    INFO(lacking);
    Stored stored;
    stored.run();
    StoredResult kept = *stored.store.find(stored.key);
    kept.arrays.erase(lacking);
    kept.texts.erase(lacking);
    stored.store.keep(stored.key, kept);
    stored.run();
    CHECK(stored.store.starts(stored.key) == 2);
  }
}

TEST_CASE("a stored run of other particles is made again") {
  Stored stored;
  stored.run();
  StoredResult kept = *stored.store.find(stored.key);
  kept.arrays["positions"].push_back(0);
  stored.store.keep(stored.key, kept);
  stored.run();
  CHECK(stored.store.starts(stored.key) == 2);
}

TEST_CASE("what levels will cost grows as it did from one to the next") {
  const std::vector<LevelCost> costs = foreseen_costs({{10, 1, 100}, {30, 2, 400}}, 4);
  REQUIRE(costs.size() == 4);
  CHECK(costs[2].work == Approx(90));
  CHECK(costs[2].seconds == Approx(6));
  CHECK(costs[3].seconds == Approx(18));
  CHECK(costs[3].bytes == Approx(6400));
  CHECK(costs[1].seconds == 2);
  // a run that was read, or stopped at once, says nothing
  CHECK(foreseen_costs({{0, 0, 0}, {30, 2, 400}}, 3)[2].seconds == Approx(2));
  CHECK(clock_seconds(seconds_of(costs, 2, 3), 1) == Approx(24));
  CHECK(clock_seconds(seconds_of(costs, 2, 3), 2) == Approx(18));
}

TEST_CASE("a ladder in space takes the finest mesh, then all others with its steps") {
  // the check of its steps half as long; the meshes below a quarter and a sixteenth
  CHECK(mesh_clock_seconds(80, 2, 1) == Approx(80 * (1 + 0.5 + 0.25 + 0.0625)));
  CHECK(mesh_clock_seconds(80, 2, 2) == Approx(80 * 1.5));  // side by side
}

TEST_CASE("levels that do not fit are refused with the numbers") {
  const std::vector<LevelCost> costs = {{1, 10, 1e9}, {2, 20, 1e9}, {4, 40, 2e9}, {8, 80, 2e9}};
  const auto affordable = [&](double seconds, double bytes, int threads = 1) {
    return affordable_levels(
        costs, 2,
        [&](size_t last) { return 30 + clock_seconds(seconds_of(costs, 2, last), threads); },
        {seconds, bytes});
  };
  CHECK(affordable(1e9, 1e12).levels == 4);
  CHECK(affordable(1e9, 1e12).refusal.empty());
  CHECK(affordable(149, 1e12).levels == 3);
  CHECK_THAT(affordable(149, 1e12).refusal,
             Contains("level 4 of 4 would take 80 s, the ladder up to it 2.5 min"));
  CHECK(affordable(149, 1e12, 2).levels == 4);  // side by side
  CHECK(affordable(69, 1e12).levels == 2);
  CHECK(affordable(1e9, 5.9e9).levels == 3);
  CHECK_THAT(affordable(1e9, 5.9e9).refusal, Contains("would keep 2 GB, the ladder up to it 6 GB"));
}

TEST_CASE("distances of runs are root mean squares by mass, the worst over common frames") {
  PerParticle3 start(3, 2), later(3, 2);
  start << 0, 1, 0, -2, 0, 0.5;
  later = start;
  later.col(0) += Vector3(3, 0, 4);
  const PerParticle mass = Eigen::Array2d(1, 3);
  CHECK(longest_side(start) == 2);
  CHECK(mean_square_root(later - start, mass) == Approx(5.0 / 2));
  CHECK(largest_difference({start, start}, {start, later}, mass) == Approx(5.0 / 2));
  CHECK(largest_difference({start}, {start, later}, mass) == 0);
  CHECK(largest_motion({start, later, start}, mass) == Approx(5.0 / 2));
  later(1, 1) = std::nan("");
  CHECK(std::isnan(largest_difference({start, later}, {start, start}, mass)));
}

}  // namespace foldproof
