#include "convergence/any_case/ablation.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <map>

#include "verification/cases/judge.h"
#include "verification/cases/quantities.h"
#include "verification/cases/self_crossings.h"

namespace foldproof {

namespace {

/// Depth inside an object at a frame [m]; 0 where there is none.
double depth_at(const Scene& scene, std::span<const Object> objects, const State& frame) {
  return objects.empty() ? 0 : value_at(*find_quantity("stays_outside"), scene, objects, frame);
}

RunObserved watched(const Case& shown, const LevelSetMakers& level_sets, int particles) {
  const Scene& scene = shown.scene;
  const Built built = build(scene, level_sets);
  const std::span<const Object> objects = built.objects;
  RunObserved run;
  std::map<double, double> energy;
  CaseJudge judge(shown, objects, level_sets);
  Worst deepest, crossings;
  const Observer observer{[&](const State& s) {
                            judge.enter(s);
                            run.times.push_back(s.time);
                            run.x.push_back(s.x.leftCols(particles));
                            deepest.see(depth_at(scene, objects, s));
                            crossings.see(self_crossings(scene, s));
                          },
                          [&](const Diagnostics& row) {
                            judge.enter(row);
                            energy[row.time] = row.energy.total();
                          }};
  const RunResult result =
      simulate(built.system, integrator_named(scene.integrator), built.start, scene.schedule, observer);
  for (const double t : run.times) run.energy.push_back(energy.contains(t) ? energy.at(t) : nan);
  run.deepest = deepest.value();
  run.crossings = crossings.value();
  run.steps = result.steps;
  run.work = result.work;
  if (result.stop) run.stopped = described(*result.stop);
  const std::vector<Record> records = judge.judged(result);
  for (size_t k = 0; k < records.size(); ++k) {
    if (!shown.expectations[k].not_asked.empty()) continue;
    run.asked.push_back(shown.expectations[k].key);
    if (records[k].outcome != Outcome::holds) run.failed.push_back(shown.expectations[k].key);
  }
  return run;
}

/// Those of `keys` that are not among `others`.
std::vector<std::string> not_in(const std::vector<std::string>& keys,
                                const std::vector<std::string>& others) {
  std::vector<std::string> left;
  for (const std::string& key : keys)
    if (std::ranges::find(others, key) == others.end()) left.push_back(key);
  return left;
}

double energy_difference(const RunObserved& a, const RunObserved& b) {
  Worst worst;
  for (size_t k = 0; k < std::min(a.energy.size(), b.energy.size()); ++k)
    worst.see(std::abs(a.energy[k] - b.energy[k]));
  return worst.value();
}

/// Why the run without the part is no run of the same scene, in words; "" if it is.
std::string reason(const RunObserved& without, const RunObserved& with, double moved, const OwnError& own) {
  if (!without.stopped.empty() && with.stopped.empty())
    return "without it the run does not come to its end: " + without.stopped;
  if (const auto failed = not_in(without.failed, with.failed); !failed.empty())
    return fmt::format("without it this expectation fails: {}", fmt::join(failed, ", "));
  if (const auto meaningless = not_in(with.asked, without.asked);
      without.stopped.empty() && !meaningless.empty())
    return fmt::format("without it this expectation has no meaning: {}", fmt::join(meaningless, ", "));
  if (without.crossings > 0 && with.crossings == 0)
    return fmt::format("without it the cloth crosses itself, in {:g} places of a frame", without.crossings);
  if (!(without.deepest <= with.deepest + own.value()))
    return fmt::format("without it cloth is {:.3g} m deep in an object, with it {:.3g} m", without.deepest,
                       with.deepest);
  if (!(moved <= own.value()))
    return fmt::format("it moves particles by {:.3g} m, more than the scene's own error of {:.3g} m", moved,
                       own.value());
  return "";
}

}  // namespace

std::string_view name_of(Need need) {
  switch (need) {
    case Need::needed:
      return "needed";
    case Need::not_needed:
      return "not needed here";
    case Need::missing:
      return "missing here";
    case Need::not_missed:
      break;
  }
  return "not missed here";
}

RunObserved observed(const Case& shown, const LevelSetMakers& level_sets, int particles) {
  const auto start = std::chrono::steady_clock::now();
  RunObserved run;
  try {
    run = watched(shown, level_sets, particles);
  } catch (const std::exception& error) {
    run.stopped = error.what();
  }
  run.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return run;
}

Case with_scene(const Case& shown, Scene scene) {
  Case changed{std::move(scene), {}, {}};
  for (const Expectation& expectation : shown.expectations) {
    const auto refusal = find_quantity(expectation.key)->refusal;
    if (!refusal || refusal(changed.scene).empty()) changed.expectations.push_back(expectation);
  }
  return changed;
}

double position_difference(const RunObserved& a, const RunObserved& b, const PerParticle& mass) {
  Worst worst;
  for (size_t k = 0; k < std::min(a.x.size(), b.x.size()); ++k) {
    const Eigen::VectorXd squares = (a.x[k] - b.x[k]).colwise().squaredNorm().transpose();
    worst.see(std::sqrt(squares.dot(mass.matrix()) / mass.sum()));
  }
  return worst.value();
}

bool PartJudged::is_as_it_should_be() const {
  const bool is_plain = need == Need::needed || need == Need::not_missed;
  return is_plain == declared.empty();
}

std::string declared_for(const Case& shown, std::string_view name) {
  for (const Declared& one : shown.declared)
    if (one.part == name) return one.why;
  return "";
}

void refuse_unknown_parts(const Case& shown, const std::vector<ScenePart>& parts) {
  for (const Declared& one : shown.declared) {
    if (one.part == finer_mesh || std::ranges::find(parts, one.part, &ScenePart::name) != parts.end())
      continue;
    std::vector<std::string> known = {std::string(finer_mesh)};
    for (const ScenePart& part : parts) known.push_back(part.name);
    throw InputError(fmt::format("{}: [ablation] names a part '{}' that cannot be toggled; known: {}",
                                 shown.scene.name, one.part, fmt::join(known, ", ")));
  }
}

double OwnError::value() const {
  double sum = 0;
  for (const double part : {time, mesh})
    if (!std::isnan(part)) sum += part;
  return std::max(sum, floor);
}

PartJudged judged(const ScenePart& part, const RunObserved& scene, RunObserved toggled, const OwnError& own,
                  const PerParticle& mass) {
  PartJudged result{part.name, part.is_present, Need::needed, "", 0, 0, "", {}};
  result.position_difference = position_difference(scene, toggled, mass);
  result.energy_difference = energy_difference(scene, toggled);
  result.because = part.is_present ? reason(toggled, scene, result.position_difference, own)
                                   : reason(scene, toggled, result.position_difference, own);
  const bool matters = !result.because.empty();
  if (part.is_present)
    result.need = matters ? Need::needed : Need::not_needed;
  else
    result.need = matters ? Need::missing : Need::not_missed;
  if (!matters)
    result.because = fmt::format("it moves particles by {:.3g} m; the scene's own error is {:.3g} m",
                                 result.position_difference, own.value());
  result.run = std::move(toggled);
  return result;
}

}  // namespace foldproof
