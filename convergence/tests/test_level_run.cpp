// Levels of a ladder: their steps, their keys, their runs from a store, their cost.
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <set>

#include "convergence/any_case/converge.h"
#include "convergence/any_case/ladder_cost.h"
#include "reference/scene/refine_cloth.h"
#include "verification/specimens/scratch_folder.h"

namespace foldproof {

using Catch::Matchers::Contains;

namespace {

constexpr const char* sheet = R"([cloth]
shape = "sheet"
width = 0.3
height = 0.2
columns = 3
rows = 2
density = 0.2
[stretch]
stiffness = 40
damping = 0.01
[gravity]
[[hold]]
particles = [0, 3]
[solver]
tolerance = 1e-9
[time]
end = 0.03
frames_per_second = 100
[[quantity]]
what = "lowest"
)";

LadderPlan trial(const std::vector<std::string>& overrides = {}) {
  const ScratchFolder folder;
  LadderPlan plan{read_case(folder.write("trial.toml", sheet), overrides), 4, {}};
  plan.measurements = measurements_of(plan.input_case);
  return plan;
}

LevelRun run_now(const Level& level) { return run_level(level, computing_provider()); }

/// The key of the first level after a change.
std::string key_after(const std::function<void(Level&)>& change) {
  Level level = time_level(trial(), 0, {});
  change(level);
  return key_of(level, "program 1");
}

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
  CHECK(std::is_sorted(finer.begin(), finer.end()));
  CHECK(divide_steps(ends, 0, 1) == ends);
  CHECK(divide_steps({}, 0, 4).empty());
}

TEST_CASE("a finer level takes the steps of the coarser, each divided") {
  const LadderPlan plan = trial();
  const LevelRun first = run_now(time_level(plan, 0, {}));
  const LevelRun third = run_now(time_level(plan, 2, first.step_ends));
  CHECK(first.stopped.empty());
  CHECK(first.step_ends.back() == 0.03);
  CHECK(third.step_ends == divide_steps(first.step_ends, 0, 4));
  CHECK(third.times == first.times);
  CHECK(first.values.size() == 1);
  CHECK(first.values[0] == first.x.back().row(1).minCoeff());
}

TEST_CASE("the key of a level changes with everything that its run depends on") {
  std::set<std::string> keys = {key_after([](Level&) {})};
  size_t different = 1;
  const auto changes = [&](const std::function<void(Level&)>& change) {
    keys.insert(key_after(change));
    return keys.size() == ++different;
  };
  const auto scene = [](Level& level) -> Scene& { return level.input_case.scene; };
  CHECK(changes([&](Level& l) { scene(l).integrator = "BDF2"; }));
  CHECK(changes([&](Level& l) { scene(l).schedule.step.fixed = 1e-3; }));
  CHECK(changes([&](Level& l) { scene(l).schedule.step.safety /= 2; }));
  CHECK(changes([&](Level& l) { scene(l).schedule.step.strain_per_step /= 2; }));
  CHECK(changes([&](Level& l) { scene(l).schedule.step.ends = {0.01, 0.02, 0.03}; }));
  CHECK(changes([&](Level& l) { scene(l).schedule.end = 0.02; }));
  CHECK(changes([&](Level& l) { scene(l).schedule.frame_interval = 0.005; }));
  CHECK(changes([&](Level& l) { scene(l).schedule.max_steps = 3; }));
  CHECK(changes([&](Level& l) { scene(l).solver.tolerance = 1e-10; }));
  CHECK(changes([&](Level& l) { scene(l).solver.max_iterations += 1; }));
  CHECK(changes([&](Level& l) { refine_cloth(scene(l)); }));
  CHECK(changes([&](Level& l) { scene(l).x(0, 5) += 1e-15; }));
  CHECK(changes([&](Level& l) { scene(l).v(0, 5) += 1e-15; }));
  CHECK(changes([&](Level& l) { scene(l).text += "# "; }));
  CHECK(changes([&](Level& l) { l.particles -= 1; }));
  CHECK(changes([&](Level& l) { l.measurements[0].what = "highest"; }));
  CHECK(changes([&](Level& l) { l.measurements[0].of.particles = {3}; }));
  CHECK(changes([&](Level& l) {
    l.measurements[0].of.box = {{Vector3(0, 0, 0), Vector3(1, 1, 1)}};
  }));
  CHECK(changes([&](Level& l) { l.measurements[0].when = Instant::maximum; }));
  CHECK(changes([&](Level& l) { l.measurements[0].time = 0.01; }));
  CHECK(changes([&](Level& l) { l.measurements[0].along = Vector3(1, 0, 0); }));
  CHECK(changes([&](Level& l) { l.measurements.push_back(l.measurements[0]); }));
  keys.insert(key_of(time_level(trial(), 0, {}), "program 2"));
  keys.insert(key_of(time_level(trial({"stretch.stiffness=41"}), 0, {}), "program 1"));
  CHECK(keys.size() == different + 2);
  // the label is for people
  CHECK(key_after([](Level& l) { l.label = "another"; }) == key_after([](Level&) {}));
}

TEST_CASE("a level is run once, and then read from the store bit for bit") {
  const ScratchFolder scratch;
  const std::string folder = scratch.file("store");
  const Level level = time_level(trial(), 0, {});
  ResultStore store(folder);
  const LevelRun made = stored_level(level, computing_provider(), store, "p");
  for (ResultStore* one : {&store, new ResultStore(folder)}) {
    const LevelRun read = stored_level(level, computing_provider(), *one, "p");
    CHECK(read.x == made.x);
    CHECK(read.times == made.times);
    CHECK(read.values == made.values);
    CHECK(read.step_ends == made.step_ends);
    CHECK(read.work == made.work);
    CHECK(read.seconds == made.seconds);
    CHECK(one->starts(key_of(level, "p")) == 1);
    if (one != &store) delete one;
  }
}

TEST_CASE("a run that stopped is kept with its reason") {
  const ScratchFolder scratch;
  Level level = time_level(trial(), 0, {});
  level.input_case.scene.schedule.max_steps = 2;
  ResultStore store(scratch.file("store"));
  for (int k = 0; k < 2; ++k) {
    const LevelRun run = stored_level(level, computing_provider(), store, "p");
    CHECK_THAT(run.stopped, Contains("cap on the number of steps"));
    CHECK(std::isnan(run.values.at(0)));
  }
  CHECK(store.starts(key_of(level, "p")) == 1);
  CHECK(std::isnan(field_difference(run_now(level), run_now(level), PerParticle::Ones(12))));
}

TEST_CASE("a stored run that lacks something is made again") {
  const Level level = time_level(trial(), 0, {});
  for (const char* lacking : {"values", "times", "positions", "kinetic", "elastic", "contacts",
                              "work", "seconds", "stopped"}) {
    INFO(lacking);
    const ScratchFolder scratch;
    ResultStore store(scratch.file("store"));
    const LevelRun made = stored_level(level, computing_provider(), store, "p");
    const std::string key = key_of(level, "p");
    StoredResult kept = *store.find(key);
    kept.arrays.erase(lacking);
    kept.texts.erase(lacking);
    store.keep(key, kept);
    CHECK(stored_level(level, computing_provider(), store, "p").x == made.x);
    CHECK(store.starts(key) == 2);
  }
}

TEST_CASE("a stored run of other particles is made again") {
  const Level level = time_level(trial(), 0, {});
  const ScratchFolder scratch;
  ResultStore store(scratch.file("store"));
  const LevelRun made = stored_level(level, computing_provider(), store, "p");
  const std::string key = key_of(level, "p");
  StoredResult kept = *store.find(key);
  kept.arrays["positions"].push_back(0);
  store.keep(key, kept);
  CHECK(stored_level(level, computing_provider(), store, "p").x == made.x);
  CHECK(store.starts(key) == 2);
}

TEST_CASE("fields differ by the largest root mean square over the frames") {
  LevelRun a, b;
  a.x = {PerParticle3::Zero(3, 2), PerParticle3::Zero(3, 2)};
  b.x = a.x;
  b.x[0].col(0) = Vector3(3, 0, 4);
  b.x[1].col(1) = Vector3(0, 2, 0);
  CHECK(field_difference(a, b, Eigen::Array2d(1, 3)) == Approx(5 / 2.0));
  CHECK(field_difference(a, b, Eigen::Array2d(1, 99)) == Approx(2 * std::sqrt(0.99)));
  b.x.pop_back();
  CHECK(std::isnan(field_difference(a, b, Eigen::Array2d(1, 3))));
}

TEST_CASE("progress goes from nothing to the end") {
  std::vector<double> shown;
  run_level(time_level(trial(), 0, {}), computing_provider(),
            [&](double part) { shown.push_back(part); });
  CHECK(std::is_sorted(shown.begin(), shown.end()));
  CHECK(shown.front() == 0);
  CHECK(shown.back() == 1);
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
  CHECK(clock_seconds(costs, 2, 3, 1) == Approx(24));
  CHECK(clock_seconds(costs, 2, 3, 2) == Approx(18));
}

TEST_CASE("a ladder in space takes the finest mesh, then all others with its steps") {
  // the check of its steps half as long; the meshes below a quarter and a sixteenth
  CHECK(mesh_clock_seconds(80, 2, 1) == Approx(80 * (1 + 0.5 + 0.25 + 0.0625)));
  CHECK(mesh_clock_seconds(80, 2, 2) == Approx(80 * 1.5));  // side by side
}

TEST_CASE("the cost of a level is its work on all particles and what it keeps") {
  Level level = time_level(trial(), 0, {});
  LevelRun run;
  run.work = 7;
  run.seconds = 3;
  run.times = {0, 1};
  run.step_ends = {0.5, 1};
  run.x = {PerParticle3::Zero(3, 5), PerParticle3::Zero(3, 5)};
  const LevelCost cost = cost_of(level, run);
  CHECK(cost.work == 7 * 12);
  CHECK(cost.seconds == 3);
  CHECK(cost.bytes == 2 * 8 * (30 + 4));
}

TEST_CASE("levels that do not fit are refused with the numbers") {
  const std::vector<LevelCost> costs = {{1, 10, 1e9}, {2, 20, 1e9}, {4, 40, 2e9}, {8, 80, 2e9}};
  const auto clock = [&](int threads) {
    return [&costs, threads](size_t last) { return 30 + clock_seconds(costs, 2, last, threads); };
  };
  CHECK(affordable_levels(costs, 2, clock(1), {1e9, 1e12}).levels == 4);
  CHECK(affordable_levels(costs, 2, clock(1), {1e9, 1e12}).refusal.empty());
  const Affordable slow = affordable_levels(costs, 2, clock(1), {149, 1e12});
  CHECK(slow.levels == 3);
  CHECK_THAT(slow.refusal, Contains("level 4 of 4 would take 80 s, the ladder up to it 2.5 min") &&
                               Contains("--hours"));
  CHECK(affordable_levels(costs, 2, clock(2), {149, 1e12}).levels == 4);  // side by side
  CHECK(affordable_levels(costs, 2, clock(1), {69, 1e12}).levels == 2);
  const Affordable large = affordable_levels(costs, 2, clock(1), {1e9, 5.9e9});
  CHECK(large.levels == 3);
  CHECK_THAT(large.refusal,
             Contains("level 4 of 4 would keep 2 GB, the ladder up to it 6 GB; 5.9 GB"));
  CHECK(duration_text(42) == "42 s");
  CHECK(duration_text(600) == "10 min");
  CHECK(duration_text(7200) == "2 h");
}

}  // namespace foldproof
