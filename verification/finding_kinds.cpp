#include "verification/finding_kinds.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace foldproof {

namespace {

/// Expectations that nearly every case has.
constexpr std::array<std::string_view, 3> generic_expectations = {
    ".runs-to-its-end", ".is-reproducible", ".never-crosses-itself"};

/// Counts that the program's text fixes. The hinge has no edge and triangle without a common
/// particle; the long case must only take the steps that it asks for.
constexpr std::array<std::string_view, 4> structural_findings = {
    "dynamics.solves-are-counted", "work-precision.C-solves-twice-as-often-as-A",
    "case.hinge.never-crosses-itself", "case.hundred_thousand_steps.takes-steps"};

/// Findings that compare processor times.
constexpr std::array<std::string_view, 1> timed_findings = {"solver.cached-terms-save-time"};

/// Words of units that count.
constexpr std::array<std::string_view, 19> counted_units = {
    "bonds",  "cases",   "corners", "evaluations", "events",    "false",   "iterations",
    "nodes",  "numbers", "pairs",   "particles",   "points",    "queries", "runs",
    "solves", "springs", "steps",   "stops",       "velocities"};

/// Words of units that are the error of the measurement itself.
constexpr std::array<std::string_view, 4> error_units = {"epsilon", "of the tolerance",
                                                         "tolerances", "standard errors"};

template <size_t n>
bool is_in(const std::array<std::string_view, n>& list, std::string_view name) {
  return std::find(list.begin(), list.end(), name) != list.end();
}

bool is_whole(double value) { return std::isfinite(value) && value == std::floor(value); }

/// A unit that counts, or the bound zero on a whole number: nothing may differ.
bool is_counted(const Verdict& verdict) {
  const bool counts = std::any_of(counted_units.begin(), counted_units.end(), [&](auto unit) {
    return std::string_view(verdict.unit).starts_with(unit);
  });
  return is_whole(verdict.measured) && (counts || verdict.bound == 0);
}

bool is_in_units_of_its_error(const Verdict& verdict) {
  return std::any_of(error_units.begin(), error_units.end(),
                     [&](auto unit) { return verdict.unit.find(unit) != std::string::npos; });
}

}  // namespace

std::string_view name_of(FindingScope scope) {
  constexpr std::string_view names[] = {"specific", "generic", "structural"};
  return names[size_t(scope)];
}

std::string_view name_of(Certainty certainty) {
  constexpr std::string_view names[] = {"estimated", "counted",    "within bound",
                                        "computed",  "timed once", "structural"};
  return names[size_t(certainty)];
}

FindingScope scope_of(const Record& record) {
  if (is_in(structural_findings, record.name)) return FindingScope::structural;
  const bool is_generic =
      std::any_of(generic_expectations.begin(), generic_expectations.end(),
                  [&](std::string_view end) { return record.name.ends_with(end); });
  return record.name.starts_with("case.") && is_generic ? FindingScope::generic
                                                        : FindingScope::specific;
}

Certainty certainty_of(const Record& record) {
  const Verdict& verdict = record.finding.verdict;
  if (verdict.uncertainty != 0) return Certainty::estimated;  // NaN, too
  if (record.kind == "bench" || is_in(timed_findings, record.name)) return Certainty::timed_once;
  if (scope_of(record) == FindingScope::structural) return Certainty::structural;
  if (is_counted(verdict)) return Certainty::counted;
  return is_in_units_of_its_error(verdict) ? Certainty::within_bound : Certainty::computed;
}

bool has_empirical_bound(const Record& record) {
  return record.finding.verdict.why_bound.starts_with("empirical");
}

double empirical_share(const std::vector<Record>& records) {
  const auto is_judged = [](const Record& record) {
    return record.outcome && record.outcome != Outcome::not_applicable;
  };
  const auto judged = std::count_if(records.begin(), records.end(), is_judged);
  const auto empirical = std::count_if(records.begin(), records.end(), [&](const Record& record) {
    return is_judged(record) && has_empirical_bound(record);
  });
  return judged == 0 ? 0 : double(empirical) / double(judged);
}

}  // namespace foldproof
