// The cheapest method of a case: found on motions whose error is known by formula.
#include <catch2/catch.hpp>

#include "convergence/any_case/precision.h"
#include "convergence/work_precision/precision_problem.h"
#include "reference/mesh/shapes.h"
#include "verification/specimens/scratch_folder.h"

using namespace foldproof;

namespace {

constexpr double end_time = 0.7;
constexpr int frames = 7;
constexpr double frame = end_time / frames;

/// A hinge that falls freely; some of its four particles are held.
Case falling(const std::vector<int>& held = {}) {
  Case input_case;
  Scene& scene = input_case.scene;
  scene = scene_at_rest(make_hinge(0.3, 0.4), 0.2);
  scene.gravity = Vector3(0, 0, -9);
  scene.schedule.end = end_time;
  scene.schedule.frame_interval = frame;
  for (const int i : held) scene.prescribed.push_back({i, scene.mesh.rest.col(i), {}});
  return input_case;
}

/// How a made-up method errs: by coefficient * parts^-order of the motion, plus a bias that no step
/// removes; with fewer than `least_parts` steps a frame it diverges halfway. In a longer run its
/// energy is that of the scene with `lasting_parts` or more, and else grows with the step, but only
/// after `quiet_times` times the case's end; a longer run costs `visits_of_step` a step.
struct Law {
  double coefficient, order;
  int least_parts;
  long work_of_step;
  double bias = 0;
  int lasting_parts = 1;
  int quiet_times = 1;
  double visits_of_step = 0;
};

using Laws = std::map<std::string, Law>;

/// The run that the law makes of the trial. Free particles move by t, from 0 to 0.7 m.
LevelRun run_by(const Law& law, const PrecisionTrial& trial, const PrecisionPlan& plan) {
  LevelRun run;
  run.steps = long(frames) * trial.parts * trial.times;
  const bool grows = trial.parts < law.lasting_parts && trial.times > law.quiet_times;
  if (trial.times > 1 && law.visits_of_step * double(run.steps) > trial.budget) {
    run.over_budget = trial.budget;
    run.stopped = "its work exceeds the budget";
    return run;
  }
  run.energy = {0.9, grows ? 0.7 * std::exp(double(law.lasting_parts) / trial.parts) : 0.7};
  run.part = trial.parts < law.least_parts ? 0.5 : 1;
  if (run.part < 1) run.stopped = "divergence";
  run.work.elastic_evaluations = std::lround(run.part * double(run.steps)) * law.work_of_step;
  run.seconds = 1e-5 * double(run.work.elastic_evaluations);
  const double error = law.coefficient * std::pow(trial.parts, -law.order) + law.bias;
  const PerParticle is_free = (plan.mass.array() > 0).cast<double>();
  for (int k = 0; k <= frames; ++k) {
    run.times.push_back(k * frame);
    run.x.push_back(plan.input_case.scene.x +
                    k * frame * Vector3(1, error, 0) * is_free.matrix().transpose());
  }
  return run;
}

/// B and RK4, which are good methods, and others; all trials that are asked for, by their laws.
struct MadeUp {
  Laws laws{{"B", {0.3, 2, 1, 5}}, {"RK4", {0.9, 4, 1, 13}}};
  PrecisionPlan plan;
  Trials trials;
  PrecisionAnswer answer;

  MadeUp(const Laws& others, const std::vector<double>& wanted, double budget = 1e9,
         double end = end_time) {
    std::vector<std::string> methods;
    for (const auto& [method, law] : others) laws[method] = law;
    for (const auto& [method, law] : laws) methods.push_back(method);
    plan = precision_plan(falling({2, 3}), methods, wanted, budget, computing_provider());
    plan.for_truth.clear();
    try_until(end, plan);
    finish();
  }

  void finish() {
    for (auto next = next_trials(plan, trials); !next.empty(); next = next_trials(plan, trials))
      for (const PrecisionTrial& trial : next)
        run_of(trials, trial) = run_by(laws.at(trial.method), trial, plan);
    answer = precision_answer(plan, trials);
  }

  const MethodPrice& price(size_t list, const std::string& method) const {
    return *std::ranges::find(answer.lists.at(list).prices, method, &MethodPrice::method);
  }
  const MethodCurve& curve(const std::string& method) const {
    return *std::ranges::find(answer.curves, method, &MethodCurve::method);
  }
  std::string sentence() const { return precision_sentences(precision_answer(plan, trials))[0]; }
};

}  // namespace

TEST_CASE("prices are those of the methods' own laws of error") {
  const MadeUp made({}, {1e-2, 1e-3});
  CHECK(made.answer.truth.motion == Approx(end_time).epsilon(1e-5));
  CHECK(made.answer.truth.uncertainty < 1e-7);
  for (size_t list = 0; list < 2; ++list)
    for (const auto& [method, law] : made.laws) {
      const double parts = std::pow(law.coefficient / made.answer.plan.wanted[list], 1 / law.order);
      const Price& price = made.price(list, method).price;
      CHECK(price.step == Approx(frame / parts).epsilon(0.01));
      CHECK(price.applications == Approx(frames * parts * double(law.work_of_step)).epsilon(0.01));
      CHECK(made.curve(method).bar.order == Approx(law.order).margin(0.01));
    }
  CHECK(made.answer.lists[0].prices.front().method == "B");
  CHECK(made.price(0, "RK4").over_best == Approx(13. / 5 * 3.080 / 5.477).epsilon(0.02));
}

TEST_CASE("the sentence names the fastest method where it is not the one of least work") {
  MadeUp made({}, {1e-2});
  CHECK(made.sentence().find("by seconds") == std::string::npos);
  const double to_tie = made.price(0, "RK4").price.seconds / made.price(0, "B").price.seconds;
  for (auto& [parts, run] : made.trials.runs.at("B")) run.seconds *= 1.02 * to_tie;
  CHECK(made.sentence().find("by seconds") == std::string::npos);
  for (auto& [parts, run] : made.trials.runs.at("B")) run.seconds *= 10;
  made.finish();  // the fastest method's step is tried, too
  CHECK(made.sentence().find("; by seconds RK4 with h = ") != std::string::npos);
}

TEST_CASE("a method outside its asymptotic range has no order") {
  MadeUp made({}, {1e-3});
  // the last difference but one, tenfold: the last order is log2(10) above the one before
  auto& runs = made.trials.runs.at("RK4");
  const int finest = runs.rbegin()->first;
  for (size_t k = 0; k < runs.at(finest).x.size(); ++k) {
    const PerParticle3 shift = 9 * (runs.at(finest / 2).x[k] - runs.at(finest / 4).x[k]);
    for (const int parts : {finest / 2, finest}) runs.at(parts).x[k] += shift;
  }
  made.answer = precision_answer(made.plan, made.trials);
  CHECK(made.curve("RK4").bar.reading == Reading::not_asymptotic);
  CHECK(made.curve("RK4").bar.order > 5);
  CHECK(std::isnan(asymptotic_order(made.curve("RK4").bar)));
  CHECK_FALSE(std::isnan(asymptotic_order(made.curve("B").bar)));
}

TEST_CASE("the largest stable step of an unstable method is bracketed") {
  const MadeUp made({{"A", {1e-5, 2, 11, 3}}}, {1e-2});
  const MethodCurve& curve = made.curve("A");
  CHECK(curve.stable_step <= frame / 11 * (1 + 1e-12));
  CHECK(curve.unstable_step >= frame / 10 * (1 - 1e-12));
  CHECK(curve.unstable_step <= 1.31 * curve.stable_step);
  CHECK(made.price(0, "A").price.limit == LimitedBy::stability);
  CHECK(made.price(0, "A").price.step == curve.stable_step);
}

TEST_CASE("a step that gains energy in a longer run has no price, and the next shorter one does") {
  for (const int quiet : {1, 2, 50}) {
    const MadeUp made({{"A", {1e-5, 2, 2, 3, 0, 11, quiet}}}, {1e-2}, 1e9,
                      end_time * (quiet + 0.4));
    const MethodPrice& price = made.price(0, "A");
    CHECK(price.price.limit == LimitedBy::longer_run);
    CHECK(price.price.step <= frame / 11 * (1 + 1e-12));
    CHECK(price.price.step > frame / (11 * 1.31));
  }
}

TEST_CASE("a larger error costs at most as much as a smaller one, wherever steps cease to last") {
  for (int lasting = 2; lasting <= 40; ++lasting) {
    const MadeUp made({{"A", {0.02, 2, 1, 3, 0, lasting}}}, {1e-2, 1e-3});
    INFO("lasting with " << lasting << " steps a frame");
    CHECK(made.price(0, "A").price.applications <= made.price(1, "A").price.applications);
  }
}

TEST_CASE("only steps that win or tie are asked whether they last") {
  const MadeUp made({{"C", {0.9, 2, 1, 20}}}, {1e-2});
  CHECK(made.trials.longer.count("B") == 1);
  CHECK(made.trials.longer.count("C") == 0);
  CHECK(made.price(0, "B").energy_gain == Approx(1).epsilon(1e-3));
  CHECK(std::isnan(made.price(0, "C").energy_gain));
}

TEST_CASE("a longer run keeps its step and its largest energy") {
  const Level trial = trial_level(falling(), {"RK4", 4, 1e6, longer});
  const LevelRun run = run_level(trial, computing_provider());
  CHECK(run.steps == longer * frames * 4);
  CHECK(run.times.back() == Approx(longer * end_time));
  CHECK(run.energy.added == run.energy.largest);
  const double mass = run.energy.added * 2 / std::pow(9 * longer * end_time, 2);
  const PrecisionPlan plan = precision_plan(falling(), {"RK4"}, {1}, 1, computing_provider());
  CHECK(mass == Approx(plan.mass.sum()));
}

TEST_CASE("a method that is never stable has no price and says why") {
  const MadeUp made({{"forward-euler", {1, 1, 1 << 30, 3}}}, {1e-2});
  CHECK(made.trials.runs.at("forward-euler").rbegin()->first <= 64);
  CHECK_FALSE(is_priced(made.price(0, "forward-euler")));
  CHECK(made.price(0, "forward-euler").because == "every run stops early: divergence");
  CHECK(made.sentence().ends_with("forward-euler does not reach it within the budget"));
  const int no_parts = 1 << 30;
  const MadeUp never({{"B", {0.3, 2, 1, 5, 0, no_parts}}, {"RK4", {0.9, 4, 1, 13, 0, no_parts}}},
                     {1e-2}, 1e5);
  CHECK_FALSE(is_priced(never.price(0, "B")));
  CHECK(never.price(0, "B").because.starts_with("no step that was tried is stable"));
}

TEST_CASE("errors below ten times the distance of the two opinions have no price") {
  const MadeUp made({{"RK4", {0.9, 4, 1, 13, 4e-4}}}, {1e-2, 1e-3}, 1e6);
  CHECK(made.answer.truth.uncertainty == Approx(4e-4).epsilon(0.02));
  CHECK(least_error(made.answer.truth) == Approx(4e-3).epsilon(0.02));
  CHECK(is_priced(made.price(0, "B")));
  CHECK_FALSE(is_priced(made.price(1, "B")));
  CHECK(made.price(1, "B").because == "the truth is not known to a tenth of this error");
}

TEST_CASE("opinions on the truth are of two families, however well their own agree") {
  const MadeUp made({{"A", {0.3, 2, 1, 5}}, {"RK4", {0.9, 1.5, 1, 13, 2e-5}}}, {1e-2});
  CHECK(made.answer.truth.first.method != "RK4");
  CHECK(made.answer.truth.second.method == "RK4");
  const PrecisionPlan one =
      precision_plan(falling(), {"A", "C"}, {1e-2}, 1e6, computing_provider());
  CHECK(one.for_truth == std::vector<std::string>{"RK4", "implicit-midpoint"});
}

TEST_CASE("a method whose steps are too long to know the motion keeps nobody from a price") {
  const MadeUp made({{"A", {0.3, 2, 1, 5}}, {"RK4", {1e7, 1, 1, 13}}}, {1e-2}, 1e4);
  CHECK(made.answer.truth.first.method != "RK4");
  CHECK(made.answer.truth.second.method != "RK4");
  CHECK(made.answer.truth.second.parts > 0);
  CHECK(is_priced(made.price(0, "B")));
  CHECK_FALSE(is_priced(made.price(0, "RK4")));
}

TEST_CASE("methods whose prices are closer than the steps tried are tied") {
  const MadeUp made({{"A", {0.33, 2, 1, 5}}, {"C", {0.6, 2, 1, 7}}}, {1e-3});
  CHECK(made.answer.lists[0].prices.front().method == "RK4");
  CHECK(made.price(0, "B").over_best == Approx(5. / 13 * 17.32 / 5.477).epsilon(0.02));
  CHECK(made.price(0, "B").is_tied);
  CHECK(made.price(0, "A").over_best == Approx(1.276).epsilon(0.02));
  CHECK_FALSE(made.price(0, "C").is_tied);
  CHECK_FALSE(made.price(0, "RK4").is_tied);
}

TEST_CASE("a method is not refined beyond sixteen times the cheapest or the budget") {
  const MadeUp made({{"forward-euler", {0.9, 1, 1, 3}}}, {1e-2, 1e-3});
  for (const auto& [parts, run] : made.trials.runs.at("forward-euler"))
    CHECK(operator_applications(run.work) <=
          dearest * made.answer.lists[1].prices.front().price.applications);
  const MadeUp poor({}, {1e-2, 1e-6}, 3e3);
  for (const auto& [method, levels] : poor.trials.runs)
    for (const auto& [parts, run] : levels)
      CHECK(visits(poor.plan.input_case.scene, run.work) <= 2.5 * 3e3);
}

TEST_CASE("where the budget ends every run, it says what would do") {
  const MadeUp made({}, {1e-2});
  CHECK(advice_in_words(made.answer).empty());
  LevelRun ended;
  ended.over_budget = made.plan.budget;
  ended.part = 0.1;
  ended.seconds = 30;
  Trials trials;
  trials.runs = {{"B", {{4, ended}}}, {"RK4", {{8, LevelRun(ended)}}}};
  trials.runs["RK4"][8].part = 0.05;
  // 4/.1 of the work, 4/.1 of 30 s
  CHECK_THAT(
      advice_in_words(precision_answer(made.plan, trials)),
      Catch::StartsWith("the budget ended the runs: B with 4 steps a frame came furthest") &&
          Catch::EndsWith("--until 0.017, or more than 40 times the --effort, 20 min a method"));
}

TEST_CASE("where two methods keep apart, the errors that they can tell are advised") {
  const MadeUp apart({{"B", {0.3, 2, 1, 5, 0.004}}}, {1e-2});  // 0.4 % from RK4, at any step
  CHECK_THAT(advice_in_words(apart.answer), Catch::EndsWith("for 4 % and more try --errors 0.04"));
  CHECK(advice_in_words(MadeUp({{"B", {0.3, 2, 1, 5, 0.004}}}, {0.04}).answer).empty());
}

TEST_CASE("forward Euler's error in free fall is the step over the time") {
  MadeUp made({}, {0.02});
  made.plan = precision_plan(falling(), {"forward-euler", "B"}, {0.02}, 1e8, computing_provider());
  made.trials = {};
  for (auto next = next_trials(made.plan, made.trials); !next.empty();
       next = next_trials(made.plan, made.trials))
    for (const PrecisionTrial& trial : next)
      run_of(made.trials, trial) = run_level(trial_level(falling(), trial), computing_provider());
  made.answer = precision_answer(made.plan, made.trials);
  CHECK(made.answer.truth.motion == Approx(9 * end_time * end_time / 2));
  for (const PrecisionRun& run : made.curve("forward-euler").runs)
    CHECK(run.error == Approx(1. / run.steps).epsilon(1e-6));
  CHECK(made.price(0, "forward-euler").price.step == Approx(0.02 * end_time).epsilon(1e-3));
  CHECK(made.price(0, "B").price.limit == LimitedBy::not_tried);
}

TEST_CASE("a case in which nothing moves has no truth and no price") {
  MadeUp made({}, {1e-2});
  for (auto& [method, levels] : made.trials.runs)
    for (auto& [parts, run] : levels)
      for (PerParticle3& x : run.x)
        x = made.plan.input_case.scene.x + 1e-17 / parts * PerParticle3::Ones(3, x.cols());
  made.answer = precision_answer(made.plan, made.trials);
  CHECK(std::isnan(made.answer.truth.uncertainty));
  CHECK_FALSE(is_priced(made.price(0, "B")));
  CHECK(truth_in_words(made.answer).starts_with("truth: unknown; nothing moves"));
}

TEST_CASE("held particles do not dilute errors") {
  const MadeUp made({}, {1e-2});
  const MethodCurve& curve = made.curve("B");
  CHECK(curve.runs[0].error == Approx(0.3 / std::pow(curve.runs[0].parts, 2)).epsilon(1e-3));
  CHECK_THROWS_AS(precision_plan(falling({0, 1, 2, 3}), {"A"}, {1e-2}, 1e6, computing_provider()),
                  InputError);
}

TEST_CASE("a kept run is found again, and made again only for a larger budget") {
  const ScratchFolder folder;
  const auto run = [&](double budget) {
    ResultStore store(folder.file("store"));
    return stored_level(trial_level(falling(), {"RK4", 64, budget}),
                        {computing_provider(), store, "me"});
  };
  CHECK(run(1000).over_budget == 1000);
  CHECK(run(1000).stopped == "its work exceeds the budget");
  const LevelRun whole = run(1e6), again = run(1000);
  CHECK(whole.stopped.empty());
  CHECK(whole.steps == 7 * 64);
  CHECK(again.steps == whole.steps);
  CHECK(again.x.back() == whole.x.back());
  CHECK(again.seconds == whole.seconds);
}

TEST_CASE("a step that was too dear to try to the end of the case is not advised") {
  const MadeUp made({{"A", {1e-5, 2, 2, 3, 0, 1, 1, 1e6}}}, {1e-2}, 1e6);
  CHECK(std::isnan(made.price(0, "A").energy_gain));
  CHECK(made.sentence().find("A with the automatic step") != std::string::npos);
}

TEST_CASE("the step that may be used was tried, with a whole number of steps a frame") {
  const MadeUp made({}, {1e-2, 1e-3});
  for (const PriceList& list : made.answer.lists) {
    const MethodPrice& best = list.prices.front();
    CHECK(best.whole_step <= best.price.step * (1 + 1e-9));
    const double parts = frame / best.whole_step;
    CHECK(parts == Approx(std::round(parts)).epsilon(1e-12));
    CHECK(made.trials.longer.at(best.method).contains(int(std::round(parts))));
  }
}
