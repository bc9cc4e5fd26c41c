#include "verification/files/baseline_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "reference/types.h"

namespace foldproof {

namespace {

constexpr double much_worse = 2;  // as `foldproof history` calls a margin

double number_of(const nlohmann::json& row, const char* key) {
  const nlohmann::json& value = row.at(key);
  return value.is_null() ? std::nan("") : value.get<double>();
}

constexpr std::string_view unrun = "did not run";  // after the end of a trial

/// holds 0, inconclusive 1, fails or did not run 2; not applicable -1
int badness(std::string_view outcome) {
  if (outcome == name_of(Outcome::not_applicable)) return -1;
  if (outcome == name_of(Outcome::holds)) return 0;
  return outcome == name_of(Outcome::inconclusive) ? 1 : 2;
}

/// How far it is from its law: measured/bound, or the number itself where the bound is 0.
double excess(double measured, double bound) { return bound > 0 ? measured / bound : measured; }

enum class Change { none, worse, better, other };

Change change_of(const KeptVerdict& kept, const Record& now) {
  const Verdict& verdict = now.finding.verdict;
  const int before = badness(kept.outcome), after = badness(outcome_text(now));
  if (did_not_run(now) && before < 0) return Change::other;  // it might not apply today, either
  if (after < 0) return before == 0 ? Change::worse : before < 0 ? Change::none : Change::other;
  if (after != before) return after > std::max(before, 0) ? Change::worse : Change::better;
  if (after == 0) return Change::none;
  const double excess_before = excess(kept.measured, kept.bound);
  const double excess_now = excess(verdict.measured, verdict.bound);
  if (std::isnan(excess_before)) return std::isnan(excess_now) ? Change::none : Change::better;
  if (!(excess_now <= much_worse * excess_before)) return Change::worse;  // NaN too
  return excess_now * much_worse < excess_before ? Change::better : Change::none;
}

/// "fails, measured/bound 3.2e+04", "holds"
std::string phrase(std::string_view outcome, double measured, double bound) {
  if (badness(outcome) <= 0 || outcome == unrun) return std::string(outcome);
  if (std::isnan(measured)) return fmt::format("{} without a number", outcome);
  return bound > 0 ? fmt::format("{}, measured/bound {:.3g}", outcome, measured / bound)
                   : fmt::format("{}, measured {:.3g}", outcome, measured);
}

KeptVerdict kept_verdict(const nlohmann::json& row) {
  KeptVerdict kept{row.at("name").get<std::string>(), row.at("outcome").get<std::string>(),
                   number_of(row, "measured"), number_of(row, "bound")};
  for (const Outcome known :
       {Outcome::holds, Outcome::fails, Outcome::inconclusive, Outcome::not_applicable})
    if (kept.outcome == name_of(known) || kept.outcome == unrun) return kept;
  throw InputError(fmt::format("the outcome of {} is '{}'", kept.name, kept.outcome));
}

Declared kept_declaration(const nlohmann::json& row) {
  return {row.at("level").get<int>(), row.at("precision").get<std::string>(),
          row.at("order").get<int>(), row.at("solve_tolerance").get<double>(),
          row.at("capabilities").get<std::vector<std::string>>()};
}

/// What widens bounds is worse; what makes laws not applicable is told, and those laws are counted.
void compare(const Declared& was, const Declared& is, BaselineChanges& changes) {
  const auto looser = [&](const std::string& now, const std::string& before) {
    changes.looser.push_back(
        fmt::format("the solver declares {}; the baseline {}: bounds are wider", now, before));
  };
  if (is.precision == "f4" && was.precision == "f8") looser("f4", "f8");
  if (is.order < was.order)
    looser(fmt::format("order {}", is.order), fmt::format("order {}", was.order));
  if (is.solve_tolerance > was.solve_tolerance)
    looser(fmt::format("solve_tolerance {:g}", is.solve_tolerance),
           fmt::format("{:g}", was.solve_tolerance));
  changes.worse = changes.looser;
  if (is.level < was.level)
    changes.other.push_back(fmt::format(
        "the solver declares level L{}; the baseline L{}: fewer laws apply", is.level, was.level));
  for (const std::string& one : was.capabilities)
    if (std::ranges::find(is.capabilities, one) == is.capabilities.end())
      changes.other.push_back(fmt::format(
          "the solver no longer declares '{}', which the baseline does: fewer laws apply", one));
}

}  // namespace

Baseline read_baseline(const std::string& path) {
  Baseline baseline;
  std::vector<KeptVerdict>& kept = baseline.verdicts;
  std::set<std::string> names;
  try {
    std::ifstream file(path);
    if (!file) throw InputError("it cannot be opened");
    const nlohmann::json whole = nlohmann::json::parse(file);
    if (whole.contains("declaration")) baseline.declared = kept_declaration(whole["declaration"]);
    for (const nlohmann::json& row : whole.at("findings")) {
      if (row.at("kind") == "claim") continue;
      kept.push_back(kept_verdict(row));
      if (!names.insert(kept.back().name).second)
        throw InputError("it has " + kept.back().name + " twice");
    }
    const auto ran = [](const KeptVerdict& one) { return one.outcome != unrun; };
    if (std::ranges::none_of(kept, ran)) throw InputError("it has no findings");
  } catch (const std::exception& error) {
    throw InputError(fmt::format("{}: no verdicts.json of a finished run: {}", path, error.what()));
  }
  return baseline;
}

BaselineChanges changes_since(const Baseline& kept, const RunRecord& run) {
  std::map<std::string, KeptVerdict> before;
  for (const KeptVerdict& one : kept.verdicts) before.emplace(one.name, one);
  BaselineChanges changes;
  if (kept.declared && run.declared) compare(*kept.declared, *run.declared, changes);
  for (const Record& now : run.records) {
    const Verdict& verdict = now.finding.verdict;
    const std::string is = phrase(outcome_text(now), verdict.measured, verdict.bound);
    const auto old = before.extract(now.name);
    if (old.empty()) {
      changes.other.push_back(fmt::format("{}: {}; not in the baseline", now.name, is));
      continue;
    }
    const KeptVerdict& was = old.mapped();
    const Change change = change_of(was, now);
    if (change == Change::none) continue;
    if (change == Change::worse) changes.worse_names.insert(now.name);
    auto& lines = change == Change::worse    ? changes.worse
                  : change == Change::better ? changes.better
                                             : changes.other;
    lines.push_back(
        fmt::format("{}: {}; was: {}", now.name, is, phrase(was.outcome, was.measured, was.bound)));
  }
  for (const auto& [name, was] : before)
    changes.other.push_back(fmt::format("{}: not asked any more; was: {}", name,
                                        phrase(was.outcome, was.measured, was.bound)));
  return changes;
}

}  // namespace foldproof
