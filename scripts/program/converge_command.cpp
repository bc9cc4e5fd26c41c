// foldproof converge: the error that a case owes to its step, quantity by quantity.
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "convergence/any_case/converge.h"
#include "scripts/program/command_line/input_files.h"
#include "scripts/program/command_line/out_folder.h"
#include "scripts/program/commands.h"
#include "scripts/program/json_text.h"
#include "scripts/program/predictability_runs.h"
#include "scripts/program/progress.h"
#include "scripts/program/provenance.h"
#include "scripts/program/run_case.h"

namespace foldproof {

namespace {

using nlohmann::json;

/// The level's run as a job; the result is left in `into`.
Job job_of(Level level, double length, const LevelSetProvider& level_sets, ResultStore& store,
           LevelRun& into) {
  return {level.input_case.scene.name, length,
          [level = std::move(level), &level_sets, &store, &into,
           program = program_identity()](const Progress&) {
            into = stored_level(level, level_sets, store, program);
            return RunRecord{};
          }};
}

/// The first level alone, since the others divide its steps; then all others at a time.
std::vector<LevelRun> ladder_runs(const LadderPlan& plan, const LevelSetProvider& level_sets,
                                  ResultStore& store, const JobSettings& running) {
  std::vector<LevelRun> runs(size_t(plan.levels));
  RunRecord unused;
  run_jobs({job_of(time_level(plan, 0, {}), 1, level_sets, store, runs[0])}, "the case as it is",
           running, unused);
  if (!runs[0].stopped.empty())
    throw InputError("the case itself comes to no end: " + runs[0].stopped);
  std::vector<Job> jobs;
  for (int k = 1; k < plan.levels; ++k)
    jobs.push_back(
        job_of(time_level(plan, k, runs[0].step_ends), 1 << k, level_sets, store, runs[size_t(k)]));
  run_jobs(jobs, "its steps divided", running, unused);
  return runs;
}

std::string number(double value) { return std::isnan(value) ? "-" : fmt::format("{:.6g}", value); }

std::string orders_in_words(const ErrorBar& bar) {
  std::string words;
  for (const double order : bar.orders)
    words += (words.empty() ? "" : " ") + (std::isnan(order) ? "-" : fmt::format("{:.2f}", order));
  return words;
}

void print(const LadderAnswer& answer) {
  fmt::print("{}, method {}, in {}: {} levels; mean step {:.3g} s down to {:.3g} s\n\n",
             answer.scene, answer.method, answer.in, answer.sizes.size(), answer.sizes.front(),
             answer.sizes.back());
  fmt::print("{:<24} {:<10} {:<16} {:>12} {:>10} {:>10}  {}\n", "quantity", "unit", "order by pair",
             "limit", "+-", "as it is", "reading");
  for (const QuantityOverLevels& q : answer.quantities)
    fmt::print("{:<24} {:<10} {:<16} {:>12} {:>10.2g} {:>10.2g}  {}\n", q.name, q.unit,
               orders_in_words(q.bar), number(q.bar.limit), q.bar.half_width, q.first_error,
               q.bar.reason.empty() ? std::string(name_of(q.bar.reading))
                                    : fmt::format("{}: {}", name_of(q.bar.reading), q.bar.reason));
  fmt::print(
      "\nlimit: Richardson's value for steps of no length; +-: error bar of the finest level (grid "
      "convergence index);\n"
      "as it is: error of the case with its own step, bar included.\n");
}

json to_json(const QuantityOverLevels& q) {
  return {{"name", q.name},
          {"unit", q.unit},
          {"values", q.values},
          {"differences", q.differences},
          {"orders", q.bar.orders},
          {"reading", name_of(q.bar.reading)},
          {"because", q.bar.reason},
          {"order", q.bar.order},
          {"limit", q.bar.limit},
          {"safety_factor", q.bar.safety},
          {"error_bar", q.bar.half_width},
          {"error_as_it_is", q.first_error}};
}

json to_json(const LadderAnswer& answer) {
  json answer_json = {{"case", answer.scene},      {"method", answer.method},
                      {"in", answer.in},           {"mean_step", answer.sizes},
                      {"work", answer.work},       {"seconds", answer.seconds},
                      {"stopped", answer.stopped}, {"quantities", json::array()}};
  for (const QuantityOverLevels& q : answer.quantities)
    answer_json["quantities"].push_back(to_json(q));
  return answer_json;
}

}  // namespace

int converge(const Options& options) {
  const LevelSetProvider level_sets = memoizing_provider(provider_for(options.cache));
  LadderPlan plan{read_case(case_file(options.file), options.overrides), options.levels, {}};
  if (!options.methods.empty()) plan.input_case.scene.integrator = options.methods.front();
  if (options.until > 0)
    plan.input_case.scene.schedule.end =
        std::min(options.until, plan.input_case.scene.schedule.end);
  plan.measurements = measurements_of(plan.input_case);
  build(plan.input_case.scene, level_sets);  // refuses now what cannot be built
  const OutFolder folder(options.out);
  ResultStore store(options.out + "/store");
  const std::vector<LevelRun> runs = ladder_runs(plan, level_sets, store, options.running);
  const PredictabilityAnswer twins = run_twins(plan, runs, level_sets, store, options);
  const LadderAnswer answer = answer_before_horizon(plan, runs, twins);
  if (options.json) {
    json answer_json = to_json(answer);
    answer_json["predictability"] = to_json(twins);
    fmt::print("{}\n", json_text(answer_json));
  } else {
    print(answer);
    print(twins);
  }
  return answer.quantities.front().bar.reading == Reading::inconclusive ? some_fail : all_hold;
}

}  // namespace foldproof
