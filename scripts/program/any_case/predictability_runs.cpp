#include "scripts/program/any_case/predictability_runs.h"

#include <fmt/format.h>

#include <cmath>

#include "scripts/program/provenance.h"

namespace foldproof {

namespace {

/// The first level, disturbed, as jobs side by side; those that the store has are read from it.
std::vector<LevelRun> disturbed_runs(const Level& first, const std::vector<double>& step_ends,
                                     const std::vector<Disturbance>& disturbances,
                                     const LevelSetProvider& level_sets, ResultStore& store,
                                     const JobSettings& running, const std::string& label) {
  std::vector<LevelRun> runs(disturbances.size());
  std::vector<Job> jobs;
  for (size_t k = 0; k < disturbances.size(); ++k)
    jobs.push_back(
        {first.input_case.scene.name, 1,
         [level = disturbed_level(first, step_ends, disturbances[k]), &level_sets, &store,
          &into = runs[k], program = program_identity()](const Progress& progress) {
           into = stored_level(level, level_sets, store, program, progress);
           return RunRecord{};
         }});
  RunRecord unused;
  if (!jobs.empty()) run_jobs(jobs, label, running, unused);
  return runs;
}

nlohmann::json to_json(const Twin& twin) {
  return {{"disturbance", twin.disturbance},
          {"distances", twin.distances},
          {"horizon", twin.horizon},
          {"stopped", twin.stopped}};
}

nlohmann::json to_json(const StatisticOverRuns& s) {
  return {{"name", s.name},   {"unit", s.unit},     {"mean", s.mean},    {"spread", s.spread},
          {"reach", s.reach}, {"levels", s.levels}, {"agrees", s.agrees}};
}

/// "all" or the numbers of the levels that do not agree.
std::string levels_outside(const StatisticOverRuns& s) {
  std::string outside;
  for (size_t k = 0; k < s.agrees.size(); ++k)
    if (!s.agrees[k]) outside += (outside.empty() ? "" : ", ") + std::to_string(k + 1);
  return outside.empty() ? "-" : outside;
}

}  // namespace

PredictabilityAnswer run_twins(const LadderPlan& plan, const std::vector<LevelRun>& runs,
                               const LevelSetProvider& level_sets, ResultStore& store,
                               const Options& options) {
  const Scene& scene = plan.input_case.scene;
  const Level first = time_level(plan, 0, {});
  const std::vector<double>& ends = runs.front().step_ends;
  const std::vector<Disturbance> two = twin_disturbances(scene, runs, options.fraction);
  const std::vector<LevelRun> twins =
      disturbed_runs(first, ends, two, level_sets, store, options.running, "its start disturbed");
  PredictabilityAnswer answer{
      predictability(scene, runs.front(), two, twins, options.fraction), 0, {}};
  if (!(answer.of.horizon < answer.of.end) || options.ensemble < 2) return answer;
  std::vector<Disturbance> further;
  for (int n = 2; n <= options.ensemble; ++n) further.push_back({two[1].size, unsigned(n)});
  std::vector<LevelRun> ensemble = disturbed_runs(first, ends, further, level_sets, store,
                                                  options.running, "an ensemble of such starts");
  ensemble.push_back(twins[1]);
  answer.ensemble = options.ensemble;
  answer.statistics = statistics_over_runs(scene, ensemble, runs, answer.of.horizon);
  return answer;
}

LadderAnswer answer_before_horizon(const LadderPlan& plan, const std::vector<LevelRun>& runs,
                                   const PredictabilityAnswer& twins) {
  const bool is_limited = twins.of.horizon < twins.of.end;
  LadderAnswer answer = time_answer(plan, is_limited ? frames_until(runs, twins.of.horizon) : runs);
  limit_to_horizon(plan.measurements, runs, twins.of, answer);
  return answer;
}

void print(const PredictabilityAnswer& answer) {
  fmt::print("{}\n", in_words(answer.of));
  if (answer.statistics.empty()) return;
  fmt::print(
      "\nmeans over the time beyond it, of {} runs with disturbed starts:\n{:<28} {:<4} {:>12} "
      "{:>10} {:>10}  {}\n",
      answer.ensemble, "statistic", "unit", "mean", "spread", "+-", "levels outside");
  for (const StatisticOverRuns& s : answer.statistics)
    fmt::print("{:<28} {:<4} {:>12.5g} {:>10.2g} {:>10.2g}  {}\n", s.name, s.unit, s.mean, s.spread,
               s.reach, levels_outside(s));
  fmt::print("+-: 95 of 100 further runs lie within it of the mean (Student's t)\n");
}

nlohmann::json to_json(const PredictabilityAnswer& answer) {
  const Predictability& p = answer.of;
  nlohmann::json told = {{"in_words", in_words(p)},
                         {"horizon", p.horizon},
                         {"fraction", p.fraction},
                         {"motion", p.motion},
                         {"end", p.end},
                         {"times", p.times},
                         {"growth_rate", p.growth.rate},
                         {"growth_rate_uncertainty", p.growth.uncertainty},
                         {"fitted_from", p.growth.from},
                         {"fitted_to", p.growth.to},
                         {"because", p.reason},
                         {"twins", {to_json(p.rounding), to_json(p.error)}},
                         {"ensemble", answer.ensemble},
                         {"statistics", nlohmann::json::array()}};
  for (const StatisticOverRuns& s : answer.statistics) told["statistics"].push_back(to_json(s));
  return told;
}

}  // namespace foldproof
