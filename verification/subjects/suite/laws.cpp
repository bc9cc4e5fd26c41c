#include "verification/subjects/suite/laws.h"

#include <variant>

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

/// Throws NotOffered if the solver lacks this word of Law::needs.
void require(Trial& trial, const std::string& need) {
  if (need == "bending" || need == "touches" || need == "still") return;
  if (need == "L1" || need == "L2") return trial.require_level(need[1] - '0');
  if (need != "order" && need != "f8") return trial.require(need);
  if (need == "order" && trial.declaration().order == 0) throw NotOffered{"a claimed order"};
  if (need == "f8" && trial.declaration().is_single) throw NotOffered{"double precision"};
}

/// "observed 0.98": of a column, in this row.
std::string cell_text(const Column& column, size_t row) {
  if (const auto* texts = std::get_if<std::vector<std::string>>(&column.values))
    return fmt::format("{} {}", column.name, texts->at(row));
  const std::string unit = column.unit.empty() || column.unit == "1" ? "" : " " + column.unit;
  const double value = std::get<std::vector<double>>(column.values).at(row);
  if (!std::isfinite(value)) return column.name + " no number";
  return fmt::format("{} {:.4g}{}", column.name, value, unit);
}

/// "observed 0.98, claimed 2"; "" for a law whose judged number says it, and without evidence.
std::string headline_of(const Law& law, const Table& evidence) {
  if (law.headline.empty() || evidence.rows() == 0) return "";
  const std::vector<double>& judged = evidence.numbers(evidence.columns().back().name);
  size_t row = 0;
  for (size_t k = 1; k < judged.size(); ++k)
    if (!(judged[k] <= judged[row])) row = k;
  std::string text;
  for (const std::string& name : suite::split(law.headline, " | "))
    text += (text.empty() ? "" : ", ") + cell_text(evidence.column(name), row);
  return text.starts_with("of ") ? text.substr(3) : text;  // "of the fold height"
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

/// Runs the law. What holds though nothing happened is `vacuous`, and its note says why.
Finding run_law(const Law& law, Trial& trial, bool& is_vacuous) {
  const std::vector<std::string> needs = suite::split(law.needs, " ");
  const auto has = [&](const char* word) { return std::ranges::find(needs, word) != needs.end(); };
  for (const std::string& need : needs) require(trial, need);
  Finding finding = law.run(trial);
  if (outcome_of(finding.verdict) != Outcome::holds) return finding;
  std::string why =
      trial.observed().nothing_happened(has("touches"), trial.declaration().rounding());
  if (has("still") && (!why.empty() || !trial.observed().sent_motion))
    why = trial.deforms_when_stretched() ? ""
                                         : "nothing happened: its scene does not deform when "
                                           "it is stretched by 1 %";
  is_vacuous = !why.empty();
  if (is_vacuous) finding.note = why + (finding.note.empty() ? "" : "; ") + finding.note;
  return finding;
}

Record judge_law(const Law& law, Trial& trial) {
  bool is_undecided = false, was_cut = false;
  Record record = judge(unjudged(law), [&] {
    try {
      return run_law(law, trial, is_undecided);
    } catch (const CannotTell& too_wide) {
      is_undecided = true;
      return without_number("", too_wide.what());
    } catch (const LawTimeIsUp& late) {
      was_cut = true;
      return without_number("", late.what());
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
  if (was_cut) record.outcome.reset();
  record.finding.headline = headline_of(law, record.finding.evidence);
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

std::function<Finding(Trial&)> in_scene(Finding (*measured)(Trial&, const PortableScene&),
                                        PortableScene (*scene)()) {
  return [=](Trial& trial) { return measured(trial, scene()); };
}

Judgement judge_solver(const SolverCommand& command, const std::vector<Law>& laws,
                       const std::function<void(const Record&)>& done) {
  TrialWatch watch;
  watch.done = [&](const Record& record, const Observed&) { done(record); };
  return judge_solver(command, laws, watch);
}

Judgement judge_solver(const SolverCommand& command, const std::vector<Law>& laws,
                       const TrialWatch& watch) {
  const Law* asked = nullptr;
  WatchedSolver::Heard heard;
  if (watch.heard)
    heard = [&](const PortableScene& scene, long steps, const Snapshot& now) {
      watch.heard(*asked, scene, steps, now);
    };
  Trial trial(command, heard);
  require_program(trial);
  Judgement judgement;
  for (const Law& law : laws) {
    std::optional<Record> record = watch.kept ? watch.kept(law) : std::nullopt;
    trial.begin_law(watch.law_seconds);
    if (!record && asked && trial.has_ended()) record = not_asked(law, asked->name, trial);
    if (!record) {  // the first tells a failed start
      asked = &law;
      if (watch.before) watch.before(law);
      record = judge_law(law, trial);
    }
    judgement.records.push_back(*record);
    judgement.asked.push_back(trial.observed());
    if (watch.done) watch.done(*record, trial.observed());
  }
  judgement.smoke_holds = std::ranges::all_of(judgement.records, [](const Record& record) {
    return !is_smoke(record) || record.outcome == Outcome::holds || did_not_run(record);
  });
  judgement.declaration = trial.last_declaration();
  judgement.mapping = trial.mapping();
  return judgement;
}

}  // namespace foldproof
