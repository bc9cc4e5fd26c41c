#include "verification/claims.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace foldproof {

namespace {

const Record* record_named(const std::string& name, const std::vector<Record>& records) {
  const auto found =
      std::find_if(records.begin(), records.end(), [&](const Record& record) { return record.name == name; });
  return found == records.end() ? nullptr : &*found;
}

/// What a finding has to say: it held, it did not, or nothing.
enum class Answer { held, failed, silent };

/// A finding that failed without a number (it threw, or measured NaN) has measured nothing.
Answer answer_of(const Record* record) {
  if (!record) return Answer::silent;
  if (record->outcome == name_of(Ruling::holds)) return Answer::held;
  const Verdict& verdict = record->finding.verdict;
  const bool is_measured =
      std::isfinite(verdict.measured) && std::isfinite(verdict.bound) && std::isfinite(verdict.uncertainty);
  return record->outcome == name_of(Ruling::fails) && is_measured ? Answer::failed : Answer::silent;
}

/// How many findings of one role gave one answer.
int count_of(const std::vector<Decider>& deciders, const std::vector<Record>& records, Role role,
             Answer answer) {
  return int(std::count_if(deciders.begin(), deciders.end(), [&](const Decider& decider) {
    return decider.role == role && answer_of(record_named(decider.finding, records)) == answer;
  }));
}

}  // namespace

std::string_view name_of(Role role) {
  switch (role) {
    case Role::supports:
      return "supports";
    case Role::limits:
      return "limits";
    case Role::contradicts:
      return "contradicts";
  }
  throw std::logic_error("name_of: a role without a name");
}

std::string_view name_of(Standing standing) {
  switch (standing) {
    case Standing::confirmed:
      return "confirmed";
    case Standing::conditional:
      return "confirmed under a condition";
    case Standing::refuted:
      return "refuted";
    case Standing::undecided:
      return "undecided";
  }
  throw std::logic_error("name_of: a ruling without a name");
}

// A finding is held, failed (with numbers), or silent: missing from the run, inconclusive, not applicable, or
// stopped by an error. The first row that fits decides.
//
//   | silent      | contradicts  | supports                  | limits       | ruling      |
//   |-------------|--------------|---------------------------|--------------|-------------|
//   | one or more | any          | any                       | any          | undecided   | on part of the evidence nothing is ruled
//   | none        | one or more  | any                       | any          | refuted     | what a part refutes, the rest cannot save
//   |             |   held       |                           |              |             |
//   | none        | none held    | one or more failed, or    | any          | undecided   | what the claim needs is not there; whether the
//   |             |              |   there is none           |              |             |   paper or the program is wrong, no finding says
//   | none        | none held    | all held                  | one or more  | conditional |
//   |             |              |                           |   held       |             |
//   | none        | none held    | all held                  | none held    | confirmed   | contradictions and limits were sought, not found
//
// So a claim is refuted only by something found, never by something that is not found: a broken program can
// lose a ruling, not make one.
Standing ruling(const std::vector<Decider>& deciders, const std::vector<Record>& records) {
  const auto count = [&](Role role, Answer answer) { return count_of(deciders, records, role, answer); };
  for (const Role role : {Role::supports, Role::limits, Role::contradicts})
    if (count(role, Answer::silent) > 0) return Standing::undecided;
  if (count(Role::contradicts, Answer::held) > 0) return Standing::refuted;
  if (count(Role::supports, Answer::failed) > 0) return Standing::undecided;
  if (count(Role::supports, Answer::held) == 0) return Standing::undecided;
  return count(Role::limits, Answer::held) > 0 ? Standing::conditional : Standing::confirmed;
}

// ---- numbers in a claim's text

namespace {

[[noreturn]] void refuse(const std::string& placeholder, const std::string& why) {
  throw std::runtime_error(fmt::format("placeholder {{{}}}: {}", placeholder, why));
}

struct Placeholder {
  std::string text, finding, column, row;  // column: "" for the measured number, "bound", or of the evidence
};

/// A column's name may hold '|' itself: the finding ends at the first, the row begins after the last.
Placeholder parsed(const std::string& text) {
  const size_t first = text.find('|'), last = text.rfind('|');
  if (first == std::string::npos) return {text, text, "", ""};
  if (first == last) return {text, text.substr(0, first), text.substr(first + 1), ""};
  return {text, text.substr(0, first), text.substr(first + 1, last - first - 1), text.substr(last + 1)};
}

std::string with_unit(const Placeholder& wanted, double value, const std::string& unit) {
  if (std::isnan(value)) refuse(wanted.text, "it is not a number");
  return fmt::format("{:.3g}{}{}", value, unit == "1" || unit.empty() ? "" : " ", unit == "1" ? "" : unit);
}

/// The row whose entry in the first column of texts is `key`; the number of rows if there is none.
size_t row_of_text(const std::vector<Column>& columns, const std::string& key) {
  for (const Column& column : columns) {
    if (const auto* texts = std::get_if<std::vector<std::string>>(&column.values))
      return size_t(std::find(texts->begin(), texts->end(), key) - texts->begin());
  }
  return std::numeric_limits<size_t>::max();
}

/// NaN if any value is.
double extreme(const Placeholder& wanted, const std::vector<double>& values) {
  double result = values.front();
  for (double value : values) {
    const bool is_beyond = wanted.row == "smallest" ? value < result : value > result;
    if (is_beyond || std::isnan(value)) result = value;
    if (std::isnan(result)) break;
  }
  return result;
}

double entry_of(const Placeholder& wanted, const std::vector<Column>& columns,
                const std::vector<double>& values) {
  if (values.empty()) refuse(wanted.text, "the column is empty");
  if (wanted.row == "smallest" || wanted.row == "largest") return extreme(wanted, values);
  if (wanted.row == "first") return values.front();
  if (wanted.row == "last") return values.back();
  const bool is_number =
      !wanted.row.empty() && wanted.row.find_first_not_of("0123456789") == std::string::npos;
  const size_t row = is_number ? std::stoul(wanted.row) - 1 : row_of_text(columns, wanted.row);
  if (!(row < values.size())) refuse(wanted.text, "there is no such row");
  return values[row];
}

std::string value_of(const Placeholder& wanted, const std::vector<Record>& records) {
  const Record* record = record_named(wanted.finding, records);
  if (!record) refuse(wanted.text, "the run has no such finding");
  const Verdict& verdict = record->finding.verdict;
  if (wanted.column.empty()) return with_unit(wanted, verdict.measured, verdict.unit);
  if (wanted.row.empty() && wanted.column == "bound") return with_unit(wanted, verdict.bound, verdict.unit);
  const std::vector<Column>& columns = record->finding.evidence;
  for (const Column& column : columns) {
    const auto* values = std::get_if<std::vector<double>>(&column.values);
    if (values && column.name == wanted.column)
      return with_unit(wanted, entry_of(wanted, columns, *values), column.unit);
  }
  refuse(wanted.text, "the finding's evidence has no such column of numbers");
}

/// Calls visit(placeholder) at each and joins what it returns with the text between.
template <class Visit>
std::string with_placeholders(const std::string& text, const Visit& visit) {
  std::string result;
  size_t at = 0;
  for (size_t open = text.find('{'); open != std::string::npos; open = text.find('{', at)) {
    const size_t close = text.find('}', open);
    if (close == std::string::npos) refuse(text.substr(open + 1), "the brace is not closed");
    result += text.substr(at, open - at) + visit(parsed(text.substr(open + 1, close - open - 1)));
    at = close + 1;
  }
  return result + text.substr(at);
}

}  // namespace

std::string filled(const std::string& text, const std::vector<Record>& records) {
  return with_placeholders(text, [&](const Placeholder& wanted) { return value_of(wanted, records); });
}

std::vector<std::string> findings_named_in(const Claim& claim) {
  std::vector<std::string> names;
  for (const Decider& decider : claim.decided_by) names.push_back(decider.finding);
  with_placeholders(claim.why + claim.condition, [&](const Placeholder& wanted) {
    names.push_back(wanted.finding);
    return std::string();
  });
  return names;
}

// ---- a whole claim

std::vector<Claim> all_claims() {
  std::vector<Claim> claims = time_claims();
  for (Claim& claim : bending_claims()) claims.push_back(std::move(claim));
  for (Claim& claim : object_claims()) claims.push_back(std::move(claim));
  return claims;
}

bool is_covered(const Claim& claim, const std::vector<Record>& records) {
  const std::vector<std::string> names = findings_named_in(claim);
  return std::all_of(names.begin(), names.end(),
                     [&](const std::string& name) { return record_named(name, records) != nullptr; });
}

ClaimRecord ruled(const Claim& claim, const std::vector<Record>& records) {
  ClaimRecord result{claim, {}, ruling(claim.decided_by, records)};
  for (const Decider& decider : claim.decided_by) {
    const Record* record = record_named(decider.finding, records);
    result.outcomes.push_back(record ? record->outcome : "missing");
  }
  try {
    result.claim.why = filled(claim.why, records);
    result.claim.condition = filled(claim.condition, records);
  } catch (const std::runtime_error& error) {
    if (result.ruling != Standing::undecided)
      throw std::runtime_error("claim " + claim.id + ": " + error.what());
  }
  return result;
}

std::string outcome_of(const ClaimRecord& record) {
  if (record.ruling != record.claim.recorded) return std::string(name_of(Ruling::fails));
  const bool is_open = record.ruling == Standing::undecided;
  return std::string(name_of(is_open ? Ruling::inconclusive : Ruling::holds));
}

}  // namespace foldproof
