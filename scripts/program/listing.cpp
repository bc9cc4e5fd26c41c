#include "scripts/program/listing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "verification/verdict.h"

namespace foldproof {

namespace {

constexpr size_t widest = 100;

/// Measured and bound with the sign that holds between them, as "0.02 <= 0.05 m".
std::string comparison(const Record& record) {
  const Verdict& v = record.finding.verdict;
  const std::string unit = v.unit == "1" ? "" : v.unit;
  const auto row = [&](const char* word, int digits) {
    return fmt::format("{:>11.{}g} {:<2} {:<9.{}g} {}", v.measured, digits, word, v.bound, digits,
                       unit);
  };
  if (record.kind == "bench") return row("target", 4);
  if (std::isnan(v.measured)) return fmt::format("{:>11}", "no number");
  if (v.measured + v.uncertainty <= v.bound) return row("<=", 4);
  if (v.measured - v.uncertainty > v.bound && v.uncertainty >= 0) {
    int digits = 4;  // as many as show the difference
    while (digits < 17 &&
           fmt::format("{:.{}g}", v.measured, digits) == fmt::format("{:.{}g}", v.bound, digits))
      ++digits;
    return row(">", digits);
  }
  return fmt::format("{:>11.4g} +- {:.2g}, allowed {:.4g} {}", v.measured, v.uncertainty, v.bound,
                     unit);
}

/// What a finding measured: its headline, if it has one, then what was judged.
std::string measured(const Record& record) {
  const std::string judged = comparison(record);
  if (record.finding.headline.empty()) return judged;
  return record.finding.headline + "; " + judged.substr(judged.find_first_not_of(' '));
}

/// Lines below a row, each of the text's own.
void add_below(std::string& text, const std::string& words) {
  for (size_t at = 0; at <= words.size();) {
    const size_t end = std::min(words.find('\n', at), words.size());
    text += fmt::format("{:<14} {}\n", "", words.substr(at, end - at));
    at = end + 1;
  }
}

/// The names after the words, in lines of at most `widest`.
std::string wrapped(const std::string& words, const std::vector<std::string>& names) {
  std::string text = words;
  size_t length = words.size();
  for (size_t k = 0; k < names.size(); ++k) {
    const std::string word = names[k] + (k + 1 < names.size() ? "," : "");
    const bool fits = 15 + length + 1 + word.size() <= widest;
    text += fits ? " " + word : "\n  " + word;
    length = fits ? length + 1 + word.size() : 2 + word.size();
  }
  return text;
}

/// Below the row of a finding that does not hold.
///   others   names of those that fail by the same failure
std::string details(const Record& record, const std::vector<std::string>& others) {
  const Finding& finding = record.finding;
  std::string text;
  add_below(text, record.claim);
  const bool has_number = !std::isnan(finding.verdict.measured);
  if (!finding.verdict.why_bound.empty())
    add_below(text, (has_number ? "The bound: " : "Required: ") + finding.verdict.why_bound);
  if (!finding.note.empty()) add_below(text, "Note: " + finding.note);
  if (!others.empty())
    add_below(text, wrapped(fmt::format("The same in {} more law{}:", others.size(),
                                        others.size() == 1 ? "" : "s"),
                            others));
  return text;
}

/// The row of a finding, `count` times if more did not run for the same reason.
std::string listing_row(const Record& record, long count, const std::vector<std::string>& others) {
  const Finding& finding = record.finding;
  const auto row = [&](const std::string& name, const std::string& words) {
    return fmt::format("{:<14} {:<60} {}\n", outcome_text(record), name, words);
  };
  if (did_not_run(record) && count > 1)
    return row(fmt::format("{} and {} more", record.name, count - 1), finding.note);
  if (did_not_run(record) || record.outcome == Outcome::not_applicable)
    return row(record.name, finding.note);
  std::string text = row(record.name, measured(record));
  const bool is_undecided = record.outcome == Outcome::inconclusive &&
                            (std::isnan(finding.verdict.measured) || !finding.note.empty());
  if (record.outcome == Outcome::fails || is_undecided) text += details(record, others);
  return text;
}

/// The end of the records, from this one on, that did not run for its reason.
std::vector<Record>::const_iterator end_of_unrun(std::vector<Record>::const_iterator at,
                                                 std::vector<Record>::const_iterator end) {
  return std::find_if(at, end, [&](const Record& record) {
    return !did_not_run(record) || record.finding.note != at->finding.note;
  });
}

bool is_same_failure(const Record& a, const Record& b) {
  return !a.finding.failure.empty() && a.finding.failure == b.finding.failure;
}

}  // namespace

std::string listing(const RunRecord& run) {
  std::string text;
  const auto begin = run.records.begin(), last = run.records.end();
  for (auto at = begin; at != last;) {
    const auto end = did_not_run(*at) ? end_of_unrun(at, last) : at + 1;
    const auto is_same = [&](const Record& other) { return is_same_failure(*at, other); };
    std::vector<std::string> others;
    for (auto other = end; other != last; ++other)
      if (is_same(*other)) others.push_back(other->name);
    if (std::none_of(begin, at, is_same)) text += listing_row(*at, end - at, others);
    at = end;
  }
  return text;
}

}  // namespace foldproof
