#include "verification/subjects/suite/laws.h"

#include <algorithm>

#include "verification/subjects/suite/headlines.h"

namespace foldproof {

namespace {

Record unjudged(const Law& law) {
  Record record;
  record.name = law.name;
  record.kind = "check";
  record.claim = law.claim;
  record.source = law.source;
  return record;
}

Finding without_number(const std::string& required, const std::string& note,
                       const std::string& failure = "") {
  return {{nan, nan, nan, "1", required}, {}, note, "", failure};
}

/// Of a law after the one during which the trial ended.
Record not_asked(const Law& law, const std::string& last_law, const Trial& trial) {
  Record record = unjudged(law);
  const char* const why =
      trial.is_out_of_time() ? "the time of the trial was up during " : "the trial ended during ";
  record.finding = without_number("", why + last_law);
  return record;
}

Record judge_law(const Law& law, Trial& trial) {
  bool is_undecided = false;
  Record record = judge(unjudged(law), [&] {
    try {
      return law.run(trial);
    } catch (const CannotTell& too_wide) {
      is_undecided = true;
      return without_number("", too_wide.what());
    } catch (const TimeIsUp&) {
      trial.run_out_of_time();
      return without_number("", "");
    } catch (const FailedWithoutNumber& failure) {
      return without_number(failure.required, failure.what());
    } catch (const SolverFailure& failure) {
      trial.note(failure);
      return without_number("it must run to its end", failure.what(), failure.kind);
    }
  });
  if (trial.is_out_of_time()) return not_asked(law, law.name, trial);
  if (is_undecided) record.outcome = Outcome::inconclusive;
  record.finding.headline = headline_of(law.name, record.finding);
  return record;
}

/// A command without a program is a typing error of the user. Any other failure is judged.
void require_program(Trial& trial) {
  try {
    trial.solver();
  } catch (const SolverFailure& failure) {
    if (failure.cause == "start") throw InputError(failure.what());
  } catch (const TimeIsUp&) {  // the first law meets it again
  }
}

bool is_smoke(const Record& record) { return record.name.starts_with("smoke."); }

}  // namespace

std::vector<Law> portable_laws() {
  std::vector<Law> all;
  for (const auto& laws :
       {motion_laws(),        symmetry_laws(),    repeat_laws(),     force_laws(),
        damping_laws(),       calibration_laws(), vibration_laws(),  stability_laws(),
        game_step_laws(),     cost_laws(),        cantilever_laws(), bent_strip_laws(),
        buckling_laws(),      tipping_laws(),     drape_laws(),      wrinkle_laws(),
        chain_laws(),         contact_laws(),     floor_laws(),      fold_laws(),
        fall_laws(),          ball_laws(),        capstan_laws(),    tunnelling_laws(),
        self_collision_laws()})
    all.insert(all.end(), laws.begin(), laws.end());
  return all;
}

Judgement judge_solver(const SolverCommand& command, const std::vector<Law>& laws,
                       const std::function<void(const Record&)>& done) {
  Trial trial(command);
  require_program(trial);
  Judgement judgement;
  std::string last_law;
  for (const Law& law : laws) {
    const bool is_asked = last_law.empty() || !trial.has_ended();  // the first tells a failed start
    if (is_asked) last_law = law.name;
    judgement.records.push_back(is_asked ? judge_law(law, trial) : not_asked(law, last_law, trial));
    done(judgement.records.back());
  }
  judgement.smoke_holds = std::ranges::all_of(judgement.records, [](const Record& record) {
    return !is_smoke(record) || record.outcome == Outcome::holds || did_not_run(record);
  });
  judgement.declaration = trial.last_declaration();
  judgement.mapping = trial.mapping();
  return judgement;
}

}  // namespace foldproof
