// What a wanted error costs with another solver, from runs whose law of error is known.
#include <catch2/catch.hpp>

#include "convergence/any_case/solver_precision.h"

namespace foldproof {

namespace {

constexpr double motion = 1.7;  // m

/// A particle that moves to `motion` and the error.
LevelRun run_of_error(double error, double seconds) {
  LevelRun run;
  run.times = {0, 0.3};
  run.x = {PerParticle3::Zero(3, 1), Vector3(motion + error, 0, 0)};
  run.seconds = seconds, run.clock = 1.5 * seconds;
  return run;
}

SolverPlan plan_of(double order, int first = 4) {
  SolverPlan plan;
  plan.wanted = {1e-2, 1e-3};
  plan.mass = PerParticle::Ones(1);
  plan.motion = motion;
  plan.end = plan.frame = 0.3;
  plan.formal_order = order;
  plan.floor = 1e-13;
  plan.first = first;
  return plan;
}

using ErrorOfParts = std::function<double(int)>;

/// All runs that are asked for; error: of so many steps a frame, over the motion.
TrialLevels all_runs(const SolverPlan& plan, const ErrorOfParts& error) {
  TrialLevels runs;
  for (int parts = next_parts(plan, runs); parts > 0; parts = next_parts(plan, runs)) {
    REQUIRE(runs.size() < 40);
    runs[parts] = run_of_error(motion * error(parts), 1e-3 * parts);
    if (std::isnan(error(parts))) runs[parts].x.clear(), runs[parts].stopped = "unstable";
  }
  return runs;
}

SolverPrecision answer_of(const SolverPlan& plan, const ErrorOfParts& error) {
  return solver_precision(plan, all_runs(plan, error), {}, {});
}

}  // namespace

TEST_CASE("solver's precision: prices follow its law of error") {
  for (const double order : {1.0, 2.0}) {
    const SolverPrecision answer =
        answer_of(plan_of(order), [&](int parts) { return 0.9 * std::pow(parts, -order); });
    CHECK(answer.curve.bar.reading == Reading::asymptotic);
    CHECK(answer.is_answered());
    for (const SolverPrice& price : answer.prices) {
      const double parts = std::pow(0.9 / price.wanted, 1 / order);
      // its errors include a bar of at most a tenth of the least error
      CHECK(price.price.step == Approx(0.3 / parts).epsilon(0.1));
      CHECK(price.price.seconds == Approx(1e-3 * parts).epsilon(0.1));
      CHECK(price.price.clock == Approx(1.5e-3 * parts).epsilon(0.1));
      CHECK(price.price.limit == LimitedBy::accuracy);
      CHECK(std::isnan(price.unstable_step));
    }
  }
}

TEST_CASE("solver's precision: longer steps are tried where the first is better than needed") {
  const SolverPlan plan = plan_of(2, 256);
  const TrialLevels runs = all_runs(plan, [](int parts) { return 0.9 * std::pow(parts, -2); });
  CHECK(runs.begin()->first == 8);  // the first beyond 1 %
  CHECK(std::isfinite(solver_precision(plan, runs, {}, {}).prices[0].price.step));
}

TEST_CASE(
    "solver's precision: a step of a whole frame that is exact enough is a bound, and says so") {
  const SolverPrecision answer =
      answer_of(plan_of(2), [](int parts) { return 5e-3 * std::pow(parts, -2); });
  CHECK(answer.prices[0].price.step == Approx(0.3));
  CHECK(answer.prices[0].price.limit == LimitedBy::not_tried);
  CHECK(solver_sentences(answer, {})[0].find("h >= 300 ms (one step a frame") != std::string::npos);
  CHECK(answer.prices[1].price.limit == LimitedBy::accuracy);
  CHECK(answer.prices[1].price.step == Approx(0.3 / std::sqrt(5.0)).epsilon(0.1));
}

TEST_CASE("solver's precision: the longest stable step is found to a quarter") {
  const SolverPrecision answer =
      answer_of(plan_of(1), [](int parts) { return parts < 21 ? nan : 0.02 / parts; });
  const SolverPrice& price = answer.prices[0];
  CHECK(price.price.step <= 0.3 / 21);
  CHECK(price.unstable_step > 0.3 / 21);
  CHECK(price.unstable_step / price.price.step <= 1.34);
  CHECK(solver_sentences(answer, {})[0].find("limited by stability") != std::string::npos);
  SolverPlan plan = plan_of(1);  // a long step that hangs does not end the search
  plan.most_seconds = 10;
  TrialLevels runs;
  runs[4].stopped = "no answer within 60 s";
  runs[4].clock = 60;
  CHECK(next_parts(plan, runs) == 8);
}

TEST_CASE("solver's precision: what takes too long, or has no order, has no price but a reason") {
  SolverPlan plan = plan_of(1);
  plan.most_seconds = 0.3;
  const SolverPrecision dear = answer_of(plan, [](int parts) { return 0.9 / parts; });
  CHECK(std::isfinite(dear.prices[0].price.step));
  CHECK(dear.prices[1].because.find("would take too long") != std::string::npos);
  CHECK_FALSE(dear.is_answered());
  const SolverPrecision noisy =
      answer_of(plan, [](int parts) { return 0.1 * std::sin(3.1 * std::log2(parts)); });
  for (const SolverPrice& price : noisy.prices) {
    CHECK(price.because.find("show no order") != std::string::npos);
    CHECK(std::isnan(price.price.step));
  }
  plan.first = 256;  // where short steps are dear, longer ones show the order
  plan.most_seconds = 0.4;
  CHECK(answer_of(plan, [](int parts) { return 0.9 / parts; }).curve.bar.reading ==
        Reading::asymptotic);
}

TEST_CASE("solver's precision: another limit than the reference's is told from steps") {
  CaseTruth truth;
  truth.first.x = run_of_error(0, 1).x;
  truth.motion = motion;
  truth.uncertainty = 1e-5;
  const SolverPlan plan = plan_of(2);
  for (const double off : {0.0, 0.02}) {
    const TrialLevels runs = all_runs(plan, [&](int parts) { return off + std::pow(parts, -2); });
    const SolverPrecision answer = solver_precision(plan, runs, truth, {0, 0.3});
    CHECK((answer.from_truth > answer.explained) == (off > 0));
    CHECK(answer.from_truth / motion == Approx(off).margin(2e-4));
    CHECK(std::isnan(solver_precision(plan, runs, truth, {0, 0.2}).from_truth));
  }
}

}  // namespace foldproof
