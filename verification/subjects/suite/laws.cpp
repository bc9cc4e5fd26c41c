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
  if (need == "bending") return;
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

Record judge_law(const Law& law, Trial& trial) {
  bool is_undecided = false;
  Record record = judge(unjudged(law), [&] {
    try {
      for (const std::string& need : suite::split(law.needs, " ")) require(trial, need);
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
