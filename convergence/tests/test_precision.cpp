// The cheapest method of a case: found on motions whose error is known by formula.
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>

#include "convergence/any_case/precision_report.h"
#include "reference/mesh/shapes.h"

using namespace foldproof;

namespace {

constexpr double end_time = 0.7;
constexpr int frames = 7;

/// A hinge that falls freely, 7 frames of 0.1 s; two of its four particles are held if asked.
Case falling(bool with_held_particles) {
  Case input_case;
  Scene& scene = input_case.scene;
  scene = scene_at_rest(make_hinge(0.3, 0.4), 0.2);
  scene.name = "falling";
  scene.gravity = Vector3(0, 0, -9);
  scene.schedule.end = end_time;
  scene.schedule.frame_interval = end_time / frames;
  if (with_held_particles)
    for (const int i : {2, 3}) scene.prescribed.push_back({i, scene.mesh.rest.col(i), {}});
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

/// The run that the law makes of the trial. Free particles move by t, from 0 to 0.7 m.
TrialRun run_by(const Law& law, const PrecisionTrial& trial, const PrecisionPlan& plan) {
  TrialRun run;
  run.steps = long(frames) * trial.parts * trial.times;
  const bool grows = trial.parts < law.lasting_parts && trial.times > law.quiet_times;
  if (trial.times > 1 && law.visits_of_step * double(run.steps) > trial.budget) {
    run.over_budget = trial.budget;
    run.stopped = "its work exceeds the budget";
    return run;
  }
  run.energy = {0.9, grows ? 0.7 * std::exp(double(law.lasting_parts) / trial.parts) : 0.7};
  run.part = 1;
  if (trial.parts < law.least_parts) {
    run.stopped = "divergence";
    run.part = 0.5;
  }
  run.work.elastic_evaluations = std::lround(run.part * double(run.steps)) * law.work_of_step;
  run.seconds = 1e-5 * double(run.work.elastic_evaluations);
  const double error = law.coefficient * std::pow(trial.parts, -law.order) + law.bias;
  const PerParticle3& start = plan.input_case.scene.x;
  for (int k = 0; k <= frames; ++k) {
    const double t = end_time * k / frames;
    PerParticle3 x = start;
    for (Eigen::Index i = 0; i < x.cols(); ++i)
      if (plan.mass[i] > 0) x.col(i) += t * Vector3(1, error, 0);
    run.times.push_back(t);
    run.x.push_back(x);
  }
  return run;
}

struct MadeUp {
  PrecisionPlan plan;
  Trials trials;
};

/// Makes all trials that are still asked for, by their laws.
void finish(const std::map<std::string, Law>& laws, MadeUp& made) {
  for (auto next = next_trials(made.plan, made.trials); !next.empty();
       next = next_trials(made.plan, made.trials))
    for (const PrecisionTrial& trial : next) {
      TrialRun& run = run_of(made.trials, trial);
      REQUIRE(run.steps == 0);
      run = run_by(laws.at(trial.method), trial, made.plan);
    }
}

/// All trials that are asked for, made by their laws.
MadeUp made_by(const std::map<std::string, Law>& laws, std::vector<double> wanted,
               double budget = 1e9, double end = end_time) {
  std::vector<std::string> methods;
  for (const auto& [method, law] : laws) methods.push_back(method);
  MadeUp made{precision_plan(falling(true), methods, wanted, budget, computing_provider()), {}};
  made.plan.for_truth.clear();
  try_until(end, made.plan);
  finish(laws, made);
  return made;
}

const MethodPrice& price_of(const PrecisionAnswer& answer, size_t list, const std::string& method) {
  for (const MethodPrice& price : answer.lists.at(list).prices)
    if (price.method == method) return price;
  throw std::logic_error("no price of " + method);
}

const MethodCurve& curve_of(const PrecisionAnswer& answer, const std::string& method) {
  for (const MethodCurve& curve : answer.curves)
    if (curve.method == method) return curve;
  throw std::logic_error("no curve of " + method);
}

const std::map<std::string, Law> two_good_methods = {{"B", {0.3, 2, 1, 5}},
                                                     {"RK4", {0.9, 4, 1, 13}}};

}  // namespace

TEST_CASE("prices are those of the methods' own laws of error") {
  const MadeUp made = made_by(two_good_methods, {1e-2, 1e-3});
  const PrecisionAnswer answer = precision_answer(made.plan, made.trials);
  CHECK(answer.truth.motion == Approx(end_time).epsilon(1e-5));
  CHECK(answer.truth.first.is_extrapolated);
  CHECK(answer.truth.second.is_extrapolated);
  CHECK(answer.truth.uncertainty < 1e-7);
  for (size_t list = 0; list < 2; ++list)
    for (const auto& [method, law] : two_good_methods) {
      const double wanted = answer.plan.wanted[list];
      const double parts = std::pow(law.coefficient / wanted, 1 / law.order);
      const MethodPrice& price = price_of(answer, list, method);
      CHECK(price.price.step == Approx(end_time / frames / parts).epsilon(0.01));
      CHECK(price.price.applications ==
            Approx(frames * parts * double(law.work_of_step)).epsilon(0.01));
    }
  CHECK(answer.lists[0].prices.front().method == "B");
  CHECK(price_of(answer, 0, "RK4").over_best == Approx(13. / 5 * 3.080 / 5.477).epsilon(0.02));
}

TEST_CASE("the sentence names the fastest method where it is not the one of least work") {
  MadeUp made = made_by(two_good_methods, {1e-2});
  CHECK(precision_sentences(precision_answer(made.plan, made.trials))[0].find("by seconds") ==
        std::string::npos);
  const auto prices = precision_answer(made.plan, made.trials).lists[0].prices;
  const auto other = std::ranges::find(prices, "RK4", &MethodPrice::method);
  const double to_tie = other->price.seconds / prices.front().price.seconds;
  for (auto& [parts, run] : made.trials.runs.at("B")) run.seconds *= 1.02 * to_tie;
  CHECK(precision_sentences(precision_answer(made.plan, made.trials))[0].find("by seconds") ==
        std::string::npos);
  for (auto& [parts, run] : made.trials.runs.at("B")) run.seconds *= 10;
  finish(two_good_methods, made);  // the fastest method's step is tried, too
  const PrecisionAnswer answer = precision_answer(made.plan, made.trials);
  CHECK(precision_sentences(answer)[0].find("; by seconds RK4 with h = ") != std::string::npos);
}

TEST_CASE("each method's observed order is that of its own halved steps") {
  const MadeUp made = made_by(two_good_methods, {1e-3});
  const PrecisionAnswer answer = precision_answer(made.plan, made.trials);
  CHECK(curve_of(answer, "B").bar.order == Approx(2).margin(0.01));
  CHECK(curve_of(answer, "RK4").bar.order == Approx(4).margin(0.01));
  CHECK(curve_of(answer, "B").bar.reading == Reading::asymptotic);
}

TEST_CASE("a method outside its asymptotic range has no order") {
  MadeUp made = made_by(two_good_methods, {1e-3});
  // the last difference but one, tenfold: the last order is log2(10) above the one before
  auto& runs = made.trials.runs.at("RK4");
  const int finest = runs.rbegin()->first;
  REQUIRE(runs.contains(finest / 8));
  for (size_t k = 0; k < runs.at(finest).x.size(); ++k) {
    const PerParticle3 shift = 9 * (runs.at(finest / 2).x[k] - runs.at(finest / 4).x[k]);
    for (const int parts : {finest / 2, finest}) runs.at(parts).x[k] += shift;
  }
  const PrecisionAnswer answer = precision_answer(made.plan, made.trials);
  const MethodCurve& curve = curve_of(answer, "RK4");
  CHECK(curve.bar.reading == Reading::not_asymptotic);
  CHECK(curve.bar.order > 5);
  CHECK(std::isnan(asymptotic_order(curve.bar)));
  const Table methods = precision_record(answer, 1).tables.at(1);
  const std::vector<double>& orders = methods.numbers("order observed in the asymptotic range");
  for (size_t k = 0; k < answer.curves.size(); ++k)
    CHECK(std::isnan(orders[k]) == (answer.curves[k].method == "RK4"));
}

TEST_CASE("the largest stable step of an unstable method is bracketed") {
  std::map<std::string, Law> laws = two_good_methods;
  laws["A"] = {1e-5, 2, 11, 3};
  const MadeUp made = made_by(laws, {1e-2});
  const PrecisionAnswer answer = precision_answer(made.plan, made.trials);
  const MethodCurve& curve = curve_of(answer, "A");
  const double frame = end_time / frames;
  CHECK(curve.stable_step <= frame / 11 * (1 + 1e-12));
  CHECK(curve.unstable_step >= frame / 10 * (1 - 1e-12));
  CHECK(curve.unstable_step <= 1.31 * curve.stable_step);
  CHECK(price_of(answer, 0, "A").price.limit == LimitedBy::stability);
  CHECK(price_of(answer, 0, "A").price.step == curve.stable_step);
}

TEST_CASE("a step that gains energy in a longer run has no price, and the next shorter one does") {
  std::map<std::string, Law> laws = two_good_methods;
  laws["A"] = {1e-5, 2, 2, 3, 0, 11};
  const MadeUp made = made_by(laws, {1e-2});
  const PrecisionAnswer answer = precision_answer(made.plan, made.trials);
  const double frame = end_time / frames;
  const MethodPrice& price = price_of(answer, 0, "A");
  CHECK(price.price.limit == LimitedBy::longer_run);
  CHECK(price.price.step <= frame / 11 * (1 + 1e-12));
  CHECK(price.price.step > frame / (11 * 1.31));
  CHECK(price.spacing <= 1.31);
  const double work_of_one = price.price.applications / std::round(end_time / price.price.step);
  CHECK(work_of_one == Approx(3));
  CHECK(curve_of(answer, "A").stable_step == Approx(frame / 2));
}

TEST_CASE("an instability that shows before the end of the case costs a step its price") {
  for (const int quiet : {2, 10, 50}) {
    std::map<std::string, Law> laws = two_good_methods;
    laws["A"] = {1e-5, 2, 2, 3, 0, 11, quiet};
    const double end = end_time * (quiet + 0.4);
    const MadeUp made = made_by(laws, {1e-2}, 1e9, end);
    CHECK(lasting_end(made.plan) >= end);
    const MethodPrice price = price_of(precision_answer(made.plan, made.trials), 0, "A");
    CHECK(price.price.limit == LimitedBy::longer_run);
    CHECK(price.whole_step <= end_time / frames / 11 * (1 + 1e-12));
  }
}

TEST_CASE("a step that was too dear to try to the end of the case is not advised") {
  std::map<std::string, Law> laws = two_good_methods;
  laws["A"] = {1e-5, 2, 2, 3, 0, 1, 1, 1e6};
  const MadeUp made = made_by(laws, {1e-2}, 1e6);
  const PrecisionAnswer answer = precision_answer(made.plan, made.trials);
  CHECK(std::isnan(price_of(answer, 0, "A").energy_gain));
  CHECK(precision_sentences(answer)[0].find("A with the automatic step") != std::string::npos);
}

TEST_CASE("the step that may be used was tried, with a whole number of steps a frame") {
  const MadeUp made = made_by(two_good_methods, {1e-2, 1e-3});
  const PrecisionAnswer answer = precision_answer(made.plan, made.trials);
  for (const PriceList& list : answer.lists) {
    const MethodPrice& best = list.prices.front();
    CHECK(best.whole_step <= best.price.step * (1 + 1e-9));
    const double parts = end_time / frames / best.whole_step;
    CHECK(parts == Approx(std::round(parts)).epsilon(1e-12));
    CHECK(made.trials.longer.at(best.method).contains(int(std::round(parts))));
  }
}

TEST_CASE("a larger error costs at most as much as a smaller one, wherever steps cease to last") {
  for (int lasting = 2; lasting <= 40; ++lasting) {
    std::map<std::string, Law> laws = two_good_methods;
    laws["A"] = {0.02, 2, 1, 3, 0, lasting};
    const MadeUp made = made_by(laws, {1e-2, 1e-3});
    const PrecisionAnswer answer = precision_answer(made.plan, made.trials);
    INFO("lasting with " << lasting << " steps a frame");
    CHECK(price_of(answer, 0, "A").price.applications <=
          price_of(answer, 1, "A").price.applications);
  }
}

TEST_CASE("only steps that win or tie are asked whether they last") {
  std::map<std::string, Law> laws = two_good_methods;
  laws["C"] = {0.9, 2, 1, 20};
  const MadeUp made = made_by(laws, {1e-2});
  CHECK(made.trials.longer.count("B") == 1);
  CHECK(made.trials.longer.count("C") == 0);
  const PrecisionAnswer answer = precision_answer(made.plan, made.trials);
  CHECK(price_of(answer, 0, "B").energy_gain == Approx(1).epsilon(1e-3));
  CHECK(std::isnan(price_of(answer, 0, "C").energy_gain));
}

TEST_CASE("a method that lasts with none of the steps that the budget allows has no price") {
  std::map<std::string, Law> laws = two_good_methods;
  for (auto& [method, law] : laws) law.lasting_parts = 1 << 30;
  const MadeUp made = made_by(laws, {1e-2}, 1e5);
  const PrecisionAnswer answer = precision_answer(made.plan, made.trials);
  for (const MethodPrice& price : answer.lists[0].prices) {
    CHECK(std::isnan(price.price.applications));
    CHECK(price.because == "no step that was tried is stable in a run until 2.1 s");
  }
}

TEST_CASE("a longer run keeps its step and its largest energy") {
  const Case input_case = falling(false);
  const TrialRun run = run_trial(input_case, {"RK4", 4, 1e6, longer}, computing_provider());
  CHECK(run.steps == longer * frames * 4);
  CHECK(run.times.back() == Approx(longer * end_time));
  CHECK(run.energy.added == run.energy.largest);
  const double mass = run.energy.added * 2 / std::pow(9 * longer * end_time, 2);
  const PrecisionPlan plan = precision_plan(input_case, {"RK4"}, {1}, 1, computing_provider());
  CHECK(mass == Approx(plan.mass.sum()));
}

TEST_CASE("a method that is never stable has no price and says why") {
  std::map<std::string, Law> laws = two_good_methods;
  laws["forward-euler"] = {1, 1, 1 << 30, 3};
  const MadeUp made = made_by(laws, {1e-2});
  CHECK(made.trials.runs.at("forward-euler").rbegin()->first <= 64);
  const PrecisionAnswer answer = precision_answer(made.plan, made.trials);
  CHECK(std::isnan(price_of(answer, 0, "forward-euler").price.applications));
  CHECK(price_of(answer, 0, "forward-euler").because == "every run stops early: divergence");
  CHECK(precision_sentences(answer)[0].ends_with(
      "forward-euler does not reach it within the budget"));
}

TEST_CASE("errors below ten times the distance of the two opinions have no price") {
  std::map<std::string, Law> laws = two_good_methods;
  laws["RK4"].bias = 4e-4;
  const MadeUp made = made_by(laws, {1e-2, 1e-3}, 1e6);
  const PrecisionAnswer answer = precision_answer(made.plan, made.trials);
  CHECK(answer.truth.uncertainty == Approx(4e-4).epsilon(0.02));
  CHECK(least_error(answer.truth) == Approx(4e-3).epsilon(0.02));
  CHECK(!std::isnan(price_of(answer, 0, "B").price.applications));
  CHECK(std::isnan(price_of(answer, 1, "B").price.applications));
  CHECK(price_of(answer, 1, "B").because == "the truth is not known to a tenth of this error");
}

TEST_CASE("opinions on the truth are of two families, however well their own agree") {
  std::map<std::string, Law> laws = two_good_methods;
  laws["A"] = {0.3, 2, 1, 5};
  laws["RK4"] = {0.9, 1.5, 1, 13, 2e-5};
  const MadeUp made = made_by(laws, {1e-2});
  const CaseTruth truth = case_truth(made.plan, made.trials.runs);
  CHECK(truth.first.method != "RK4");
  CHECK(truth.second.method == "RK4");
  const PrecisionPlan one =
      precision_plan(falling(false), {"A", "C"}, {1e-2}, 1e6, computing_provider());
  CHECK(one.for_truth == std::vector<std::string>{"RK4", "implicit-midpoint"});
}

TEST_CASE("methods that only serve the truth are named as such, and steps that do not last, too") {
  MadeUp made = made_by(two_good_methods, {1e-2});
  CHECK(for_truth_in_words(precision_answer(made.plan, made.trials)).empty());
  made.plan.methods = {"B"};
  made.plan.for_truth = {"RK4"};
  const PrecisionAnswer answer = precision_answer(made.plan, made.trials);
  const std::string why = "RK4 was not requested: it serves only to find the truth";
  CHECK(for_truth_in_words(answer).starts_with(why));
  const StudyRecord record = precision_record(answer, 1);
  CHECK(record.about.find(why) != std::string::npos);
  CHECK(record.about.find("One that does not last there gets no price") != std::string::npos);
  for (const Figure& figure : record.figures) CHECK(figure.caption.find(why) != std::string::npos);
}

TEST_CASE("methods whose prices are closer than the steps tried are tied") {
  std::map<std::string, Law> laws = two_good_methods;
  laws["A"] = {0.33, 2, 1, 5};
  laws["C"] = {0.6, 2, 1, 7};
  const MadeUp made = made_by(laws, {1e-3});
  const PrecisionAnswer answer = precision_answer(made.plan, made.trials);
  const std::string best = answer.lists[0].prices.front().method;
  CHECK(best == "RK4");
  CHECK(price_of(answer, 0, "B").over_best == Approx(5. / 13 * 17.32 / 5.477).epsilon(0.02));
  CHECK(price_of(answer, 0, "B").is_tied);
  CHECK(price_of(answer, 0, "A").over_best == Approx(1.276).epsilon(0.02));
  CHECK_FALSE(price_of(answer, 0, "C").is_tied);
  CHECK_FALSE(price_of(answer, 0, best).is_tied);
  for (const MethodPrice& price : answer.lists[0].prices)
    if (price.over_best < 2.5) CHECK(price.spacing < 1.31);
}

TEST_CASE("a method is not refined beyond sixteen times the cheapest or the budget") {
  std::map<std::string, Law> laws = two_good_methods;
  laws["forward-euler"] = {0.9, 1, 1, 3};
  const MadeUp made = made_by(laws, {1e-2, 1e-3});
  const double cheapest =
      precision_answer(made.plan, made.trials).lists[1].prices.front().price.applications;
  for (const auto& [parts, run] : made.trials.runs.at("forward-euler"))
    CHECK(operator_applications(run.work) <= dearest * cheapest);
  const MadeUp poor = made_by(two_good_methods, {1e-2, 1e-6}, 3e3);
  for (const auto& [method, levels] : poor.trials.runs)
    for (const auto& [parts, run] : levels)
      CHECK(visits(poor.plan.input_case.scene, run.work) <= 2.5 * 3e3);
}

TEST_CASE("forward Euler's error in free fall is the step over the time") {
  const Case input_case = falling(false);
  const PrecisionPlan plan =
      precision_plan(input_case, {"forward-euler", "B"}, {0.02}, 1e8, computing_provider());
  Trials trials;
  for (auto next = next_trials(plan, trials); !next.empty(); next = next_trials(plan, trials))
    for (const PrecisionTrial& trial : next)
      run_of(trials, trial) = run_trial(input_case, trial, computing_provider());
  const PrecisionAnswer answer = precision_answer(plan, trials);
  CHECK(answer.truth.motion == Approx(9 * end_time * end_time / 2));
  for (const PrecisionRun& run : curve_of(answer, "forward-euler").curve.runs)
    CHECK(run.error == Approx(1. / run.steps).epsilon(1e-6));
  CHECK(price_of(answer, 0, "forward-euler").price.step == Approx(0.02 * end_time).epsilon(1e-3));
  CHECK(price_of(answer, 0, "B").price.limit == LimitedBy::not_tried);
}

TEST_CASE("a case in which nothing moves has no truth and no price") {
  MadeUp made = made_by(two_good_methods, {1e-2});
  for (auto& [method, levels] : made.trials.runs)
    for (auto& [parts, run] : levels)
      for (PerParticle3& x : run.x)
        x = made.plan.input_case.scene.x + 1e-17 / parts * PerParticle3::Ones(3, x.cols());
  const PrecisionAnswer answer = precision_answer(made.plan, made.trials);
  CHECK(std::isnan(answer.truth.uncertainty));
  CHECK(std::isnan(answer.lists[0].prices.front().price.applications));
  CHECK(truth_in_words(answer).starts_with("truth: unknown; nothing moves"));
}

TEST_CASE("held particles do not dilute errors") {
  const MadeUp made = made_by(two_good_methods, {1e-2});
  const auto curves =
      method_curves(made.plan, made.trials, case_truth(made.plan, made.trials.runs));
  const MethodCurve& curve = curves.front();
  CHECK(curve.curve.runs[0].error == Approx(0.3 / std::pow(curve.parts[0], 2)).epsilon(1e-3));
  Case all_held = falling(false);
  for (int i = 0; i < 4; ++i)
    all_held.scene.prescribed.push_back({i, all_held.scene.mesh.rest.col(i), {}});
  CHECK_THROWS_AS(precision_plan(all_held, {"A"}, {1e-2}, 1e6, computing_provider()), InputError);
}

TEST_CASE("a kept run is found again, and made again only for a larger budget") {
  const std::string folder = "precision test store";
  std::filesystem::remove_all(folder);
  const Case input_case = falling(false);
  const PrecisionTrial poor{"RK4", 64, 1000}, rich{"RK4", 64, 1e6};
  {
    ResultStore store(folder);
    const TrialRun run = stored_trial(input_case, poor, computing_provider(), store, "me");
    CHECK(run.over_budget == 1000);
    CHECK(run.part < 1);
    CHECK(run.stopped == "its work exceeds the budget");
  }
  ResultStore store(folder);
  stored_trial(input_case, poor, computing_provider(), store, "me");
  const TrialRun whole = stored_trial(input_case, rich, computing_provider(), store, "me");
  CHECK(whole.stopped.empty());
  CHECK(whole.steps == 7 * 64);
  const TrialRun again = stored_trial(input_case, poor, computing_provider(), store, "me");
  CHECK(again.steps == whole.steps);
  CHECK(again.work.elastic_evaluations == whole.work.elastic_evaluations);
  CHECK(again.x.back() == whole.x.back());
  CHECK(again.seconds == whole.seconds);
  std::filesystem::remove_all(folder);
}
