#include "verification/subjects/suite/laws.h"

#include <algorithm>

namespace foldproof {

namespace {

Record judge_law(const Law& law, Trial& trial) {
  Record record;
  record.name = law.name;
  record.kind = "check";
  record.claim = law.claim;
  record.source = law.source;
  return judge(std::move(record), [&] {
    try {
      return law.run(trial);
    } catch (const SolverFailure& failure) {
      trial.note(failure);
      throw;
    }
  });
}

/// A command without a program is a typing error of the user. Any other failure is judged.
void require_program(Trial& trial) {
  try {
    trial.solver();
  } catch (const SolverFailure& failure) {
    if (failure.cause == "start") throw InputError(failure.what());
  }
}

bool is_smoke(const Record& record) { return record.name.starts_with("smoke."); }

}  // namespace

std::vector<Law> portable_laws() {
  std::vector<Law> all;
  for (const auto& laws : {motion_laws(), symmetry_laws(), repeat_laws(), force_laws(),
                           calibration_laws(), vibration_laws(), stability_laws(), cost_laws(),
                           cantilever_laws(), bent_strip_laws(), buckling_laws(), tipping_laws(),
                           chain_laws(), contact_laws(), tunnelling_laws(), self_collision_laws()})
    all.insert(all.end(), laws.begin(), laws.end());
  return all;
}

Judgement judge_solver(const SolverCommand& command, const std::vector<Law>& laws,
                       const std::function<void(const Record&)>& done) {
  Trial trial(command);
  require_program(trial);
  Judgement judgement;
  for (const Law& law : laws) {
    judgement.records.push_back(judge_law(law, trial));
    done(judgement.records.back());
  }
  judgement.smoke_holds = std::ranges::all_of(judgement.records, [](const Record& record) {
    return !is_smoke(record) || record.outcome == Outcome::holds;
  });
  try {
    judgement.declaration = trial.declaration();
  } catch (const SolverFailure&) {  // its records say so
  }
  judgement.mapping = trial.mapping();
  return judgement;
}

}  // namespace foldproof
