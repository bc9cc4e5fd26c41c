#include "verification/claims/claims.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>

namespace foldproof {

namespace {

const Record* record_named(const std::string& name, const std::vector<Record>& records) {
  const auto found = std::find_if(records.begin(), records.end(),
                                  [&](const Record& record) { return record.name == name; });
  return found == records.end() ? nullptr : &*found;
}

/// State of a finding: it held, it did not, or it is undecided.
enum class Answer { held, failed, silent };

/// A finding that failed without a number (it threw, or measured NaN) has measured nothing.
Answer answer_of(const Record* record) {
  if (!record) return Answer::silent;
  if (record->outcome == Outcome::holds) return Answer::held;
  const Verdict& verdict = record->finding.verdict;
  const bool is_measured = std::isfinite(verdict.measured) && std::isfinite(verdict.bound) &&
                           std::isfinite(verdict.uncertainty);
  return record->outcome == Outcome::fails && is_measured ? Answer::failed : Answer::silent;
}

/// How many findings of one role gave one answer.
int count_of(const std::vector<Decider>& deciders, const std::vector<Record>& records, Role role,
             Answer answer) {
  return int(std::count_if(deciders.begin(), deciders.end(), [&](const Decider& decider) {
    const Record* const record = record_named(decider.finding, records);
    return decider.role == role && answer_of(record) == answer;
  }));
}

}  // namespace

std::string_view name_of(Role role) {
  constexpr std::string_view names[] = {"supports", "limits", "contradicts"};
  return names[size_t(role)];
}

std::string_view name_of(Ruling ruling) {
  constexpr std::string_view names[] = {"confirmed", "confirmed under a condition", "refuted",
                                        "undecided"};
  return names[size_t(ruling)];
}

// A finding is held, failed (with numbers), or silent: missing from the run, inconclusive, not
// applicable, or stopped by an error. The first row that fits decides.
//
//       | silent      | contradicts      | any role    | supports  | limits    | ruling      |
//   |---|-------------|------------------|-------------|-----------|-----------|-------------|
//   | 1 | one or more | any              | any         | any       | any       | undecided   |
//   | 2 | none        | one or more held | any         | any       | any       | refuted     |
//   | 3 | none        | none held        | some failed | any       | any       | undecided   |
//   | 4 | none        | there is none    | all held    | none      | any       | undecided   |
//   | 5 | none        | there is none    | all held    | some held | some held | conditional |
//   | 6 | none        | there is none    | all held    | some held | none      | confirmed   |
//
//   1: on part of the evidence nothing is ruled
//   2: what a part refutes, the rest cannot save
//   3: what the claim needs is not there, or what was recorded against it: is the paper or the
//      program wrong? no finding says
//
// So every ruling rests on findings that hold. A broken program can lose a ruling, not make one: a
// limit or a contradiction that fails does not better a claim.
Ruling ruling(const std::vector<Decider>& deciders, const std::vector<Record>& records) {
  const auto count = [&](Role role, Answer answer) {
    return count_of(deciders, records, role, answer);
  };
  const auto count_all = [&](Answer answer) {
    return count(Role::supports, answer) + count(Role::limits, answer) +
           count(Role::contradicts, answer);
  };
  if (count_all(Answer::silent) > 0) return Ruling::undecided;
  if (count(Role::contradicts, Answer::held) > 0) return Ruling::refuted;
  if (count_all(Answer::failed) > 0) return Ruling::undecided;
  if (count(Role::supports, Answer::held) == 0) return Ruling::undecided;
  return count(Role::limits, Answer::held) > 0 ? Ruling::conditional : Ruling::confirmed;
}

// ---- numbers in a claim's text

namespace {

[[noreturn]] void reject(const std::string& placeholder, const std::string& why) {
  throw std::runtime_error(fmt::format("placeholder {{{}}}: {}", placeholder, why));
}

/// One number that a text asks for.
struct Place {
  // column: "" for the measured number, "bound", or of the evidence
  std::string finding, column, row;
};

struct Placeholder {
  std::string text;
  bool bare;                  // without the unit
  std::vector<Place> places;  // the largest of them is meant
};

/// A column's name may hold '|' itself: the finding ends at the first, the row begins
/// after the last.
Place place_of(const std::string& text) {
  const size_t first = text.find('|'), last = text.rfind('|');
  if (first == std::string::npos) return {text, "", ""};
  if (first == last) return {text.substr(0, first), text.substr(first + 1), ""};
  return {text.substr(0, first), text.substr(first + 1, last - first - 1), text.substr(last + 1)};
}

/// Does the text begin with these words? They are then cut off.
bool cut_off(std::string& text, const std::string& words) {
  if (!text.starts_with(words)) return false;
  text.erase(0, words.size());
  return true;
}

Placeholder parse_placeholder(const std::string& text) {
  std::string rest = text;
  Placeholder result{text, cut_off(rest, "bare: "), {}};
  if (!cut_off(rest, "largest of: ")) return {text, result.bare, {place_of(rest)}};
  for (size_t comma = rest.find(", "); comma != std::string::npos; comma = rest.find(", ")) {
    result.places.push_back(place_of(rest.substr(0, comma)));
    rest.erase(0, comma + 2);
  }
  result.places.push_back(place_of(rest));
  return result;
}

/// A number of the run.
struct Quantity {
  double value;
  std::string unit;
};

/// The exponent of ten as the report writes it.
std::string superscript(int exponent) {
  static const std::array<const char*, 10> digits = {"⁰", "¹", "²", "³", "⁴",
                                                     "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = exponent < 0 ? "⁻" : "";
  for (const char digit : std::to_string(std::abs(exponent))) text += digits[size_t(digit - '0')];
  return text;
}

/// Three digits, without zeros at the end.
std::string number_text(double value) {
  if (value == 0 || !std::isfinite(value)) return fmt::format("{:g}", value);
  const std::string scientific = fmt::format("{:.2e}", value);
  const size_t e = scientific.find('e');
  const int exponent = std::stoi(scientific.substr(e + 1));
  if (exponent >= -3 && exponent < 6)
    return fmt::format("{:.{}g}", std::stod(scientific), std::max(3, exponent + 1));
  return fmt::format("{:g}×10{}", std::stod(scientific.substr(0, e)), superscript(exponent));
}

std::string text_of(const Placeholder& wanted, const Quantity& quantity) {
  if (std::isnan(quantity.value)) reject(wanted.text, "it is not a number");
  const bool without = wanted.bare || quantity.unit == "1" || quantity.unit.empty();
  return number_text(quantity.value) + (without ? "" : " " + quantity.unit);
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
double extreme(const std::string& row, const std::vector<double>& values) {
  double result = values.front();
  for (double value : values) {
    const bool is_beyond = row == "smallest" ? value < result : value > result;
    if (is_beyond || std::isnan(value)) result = value;
    if (std::isnan(result)) break;
  }
  return result;
}

double entry_of(const Placeholder& wanted, const std::string& row,
                const std::vector<Column>& columns, const std::vector<double>& values) {
  if (values.empty()) reject(wanted.text, "the column is empty");
  if (row == "smallest" || row == "largest") return extreme(row, values);
  if (row == "first") return values.front();
  if (row == "last") return values.back();
  const bool is_number = !row.empty() && row.find_first_not_of("0123456789") == std::string::npos;
  const size_t index = is_number ? std::stoul(row) - 1 : row_of_text(columns, row);
  if (!(index < values.size())) reject(wanted.text, "there is no such row");
  return values[index];
}

Quantity quantity_at(const Placeholder& wanted, const Place& place,
                     const std::vector<Record>& records) {
  const Record* record = record_named(place.finding, records);
  if (!record) reject(wanted.text, "the run has no such finding");
  const Verdict& verdict = record->finding.verdict;
  if (place.column.empty()) return {verdict.measured, verdict.unit};
  if (place.row.empty() && place.column == "bound") return {verdict.bound, verdict.unit};
  const std::vector<Column>& columns = record->finding.evidence.columns();
  for (const Column& column : columns) {
    const auto* values = std::get_if<std::vector<double>>(&column.values);
    if (values && column.name == place.column)
      return {entry_of(wanted, place.row, columns, *values), column.unit};
  }
  reject(wanted.text, "the finding's evidence has no such column of numbers");
}

/// The word in a column of texts; none if the place is no such column.
std::optional<std::string> word_at(const Placeholder& wanted, const Place& place,
                                   const std::vector<Record>& records) {
  const Record* record = record_named(place.finding, records);
  if (!record || place.row.empty()) return {};
  for (const Column& column : record->finding.evidence.columns()) {
    const auto* texts = std::get_if<std::vector<std::string>>(&column.values);
    if (!texts || column.name != place.column) continue;
    if (texts->empty() || (place.row != "first" && place.row != "last"))
      reject(wanted.text, "of a column of texts there is the first word and the last");
    return place.row == "first" ? texts->front() : texts->back();
  }
  return {};
}

std::string value_of(const Placeholder& wanted, const std::vector<Record>& records) {
  if (wanted.places.size() == 1)
    if (const auto word = word_at(wanted, wanted.places.front(), records)) return *word;
  Quantity largest = quantity_at(wanted, wanted.places.front(), records);
  for (const Place& place : wanted.places) {
    const Quantity one = quantity_at(wanted, place, records);
    if (one.unit != largest.unit) reject(wanted.text, "its numbers have different units");
    if (!(one.value <= largest.value)) largest = one;
    if (std::isnan(largest.value)) break;
  }
  return text_of(wanted, largest);
}

/// Calls visit(placeholder) at each and joins what it returns with the text between.
template <class Visit>
std::string with_placeholders(const std::string& text, const Visit& visit) {
  std::string result;
  size_t at = 0;
  for (size_t open = text.find('{'); open != std::string::npos; open = text.find('{', at)) {
    const size_t close = text.find('}', open);
    if (close == std::string::npos) reject(text.substr(open + 1), "the brace is not closed");
    result += text.substr(at, open - at) +
              visit(parse_placeholder(text.substr(open + 1, close - open - 1)));
    at = close + 1;
  }
  return result + text.substr(at);
}

}  // namespace

std::string fill_placeholders(const std::string& text, const std::vector<Record>& records) {
  return with_placeholders(text,
                           [&](const Placeholder& wanted) { return value_of(wanted, records); });
}

std::vector<std::string> findings_in_text(const std::string& text) {
  std::vector<std::string> names;
  with_placeholders(text, [&](const Placeholder& wanted) {
    for (const Place& place : wanted.places) names.push_back(place.finding);
    return std::string();
  });
  return names;
}

std::vector<std::string> findings_named_in(const Claim& claim) {
  std::vector<std::string> names;
  for (const Decider& decider : claim.decided_by) names.push_back(decider.finding);
  for (const std::string& text : {claim.why, claim.condition})
    for (const std::string& name : findings_in_text(text)) names.push_back(name);
  return names;
}

// ---- a whole claim

std::string place_of(const Claim& claim) {
  const bool is_number = !claim.section.empty() && std::isdigit(claim.section.front());
  return claim.paper + (is_number ? " section " : ", ") + claim.section;
}

bool is_covered(const Claim& claim, const std::vector<Record>& records) {
  const std::vector<std::string> names = findings_named_in(claim);
  return !names.empty() && std::all_of(names.begin(), names.end(), [&](const std::string& name) {
    return record_named(name, records) != nullptr;
  });
}

ClaimRecord rule_claim(const Claim& claim, const std::vector<Record>& records) {
  ClaimRecord result{claim, {}, ruling(claim.decided_by, records)};
  std::vector<Decider> others;  // than those that the run lacks because it is of the quick tier
  for (const Decider& decider : claim.decided_by) {
    const Record* record = record_named(decider.finding, records);
    result.outcomes.push_back(record ? std::string(outcome_text(*record)) : "missing");
    if (record || !decider.only_in_full_tier) others.push_back(decider);
  }
  if (others.size() < claim.decided_by.size() && ruling(others, records) == claim.recorded)
    result.claim.missing = fmt::format(
        "{} of its {} deciding findings, which only the full tier makes; the others "
        "rule as recorded",
        claim.decided_by.size() - others.size(), claim.decided_by.size());
  try {
    result.claim.why = fill_placeholders(claim.why, records);
    result.claim.condition = fill_placeholders(claim.condition, records);
  } catch (const std::runtime_error& error) {
    if (result.ruling != Ruling::undecided)
      throw std::runtime_error("claim " + claim.id + ": " + error.what());
  }
  return result;
}

Outcome outcome_of(const ClaimRecord& record) {
  if (waits_for_full_tier(record)) return Outcome::inconclusive;
  if (record.ruling != record.claim.recorded) return Outcome::fails;
  const bool is_open = record.ruling == Ruling::undecided;
  return is_open ? Outcome::inconclusive : Outcome::holds;
}

bool is_out_of_reach(const ClaimRecord& record) {
  return record.ruling == Ruling::undecided && record.claim.decided_by.empty() &&
         !record.claim.missing.empty();
}

bool waits_for_full_tier(const ClaimRecord& record) {
  return record.ruling == Ruling::undecided && !record.claim.decided_by.empty() &&
         !record.claim.missing.empty();
}

}  // namespace foldproof
