#include "scripts/program/judge/look_first.h"

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

bool fails(const PlantedBug& bug, const std::string& law) {
  return std::ranges::find(bug.fails, law) != bug.fails.end();
}

bool does_not_hold(const Record& record) {
  return record.outcome == Outcome::fails || record.outcome == Outcome::inconclusive;
}

bool is_decided(const Record& record) {
  return record.outcome && record.outcome != Outcome::not_applicable;
}

/// Jaccard's similarity of the bug's laws and those that do not hold.
double likeness(const PlantedBug& bug, const std::vector<const Record*>& decided) {
  double both = 0, either = 0;
  for (const Record* record : decided) {
    const bool expected = fails(bug, record->name), seen = does_not_hold(*record);
    both += expected && seen, either += expected || seen;
  }
  return either > 0 ? both / either : 0;
}

using Words = std::set<std::string>;

/// Those of a law's name: "box.lets-go" has box, lets, go.
void add_words(const std::string& law, Words& words) {
  std::string word;
  for (const char c : law + "-") {
    if (c != '.' && c != '-') {
      word += c;
    } else {
      words.insert(word);
      word.clear();
    }
  }
}

/// Of the decided laws that the bug fails.
Words words_of(const PlantedBug& bug, const std::vector<const Record*>& decided) {
  Words words;
  for (const Record* record : decided)
    if (fails(bug, record->name)) add_words(record->name, words);
  return words;
}

/// Naive Bayes: each word stands in the names of laws that do not hold, or not, as often as with
/// the bugs of this kind. Laws with common words say alike things, also those that no bug fails.
double log_likelihood(const std::vector<Words>& bugs, const Words& all, const Words& seen) {
  const double count = double(bugs.size());
  double sum = std::log(count);
  for (const std::string& word : all) {
    const auto has = [&](const Words& of_bug) { return of_bug.contains(word); };
    const double share = (double(std::ranges::count_if(bugs, has)) + 0.5) / (count + 1);
    sum += std::log(seen.contains(word) ? share : 1 - share);
  }
  return sum;
}

}  // namespace

std::vector<PlantedBug> read_planted_bugs(const std::string& path) {
  std::vector<PlantedBug> bugs;
  std::ifstream file(path);
  long number = 0;
  for (std::string line; std::getline(file, line);) {
    ++number;
    try {
      const nlohmann::json row = nlohmann::json::parse(line);
      bugs.push_back({row.at("bug"), row.at("class"), row.at("fails")});
    } catch (const nlohmann::json::exception& error) {
      throw InputError(
          fmt::format("{}:{}: write {{\"bug\": NAME, \"class\": CLASS, \"fails\": [LAW, ...]}}: {}",
                      path, number, error.what()));
    }
  }
  return bugs;
}

std::vector<LikelyCause> likely_causes(const std::vector<PlantedBug>& bugs,
                                       const std::vector<Record>& records) {
  std::vector<const Record*> decided;
  Words seen, all;
  for (const Record& record : records) {
    if (!is_decided(record)) continue;
    decided.push_back(&record);
    if (does_not_hold(record)) add_words(record.name, seen);
  }
  std::map<std::string, std::vector<const PlantedBug*>> kinds;
  std::map<std::string, std::vector<Words>> words;
  for (const PlantedBug& bug : bugs) {
    if (bug.fails.empty()) continue;  // it has no pattern
    kinds[bug.kind].push_back(&bug);
    words[bug.kind].push_back(words_of(bug, decided));
    for (const std::string& word : words[bug.kind].back()) all.insert(word);
  }
  if (std::ranges::none_of(seen, [&](const std::string& word) { return all.contains(word); }))
    return {};
  std::vector<LikelyCause> causes;
  for (const auto& [kind, of_kind] : kinds) {
    const auto alike = [&](const PlantedBug* bug) { return likeness(*bug, decided); };
    causes.push_back({kind, (*std::ranges::max_element(of_kind, {}, alike))->name,
                      log_likelihood(words[kind], all, seen)});
  }
  std::ranges::sort(causes, std::greater(), &LikelyCause::odds);
  double sum = 0;
  for (const LikelyCause& cause : causes) sum += std::exp(cause.odds - causes.front().odds);
  const double likeliest = causes.empty() ? 0 : causes.front().odds;
  for (LikelyCause& cause : causes) cause.odds = std::exp(cause.odds - likeliest) / sum;
  return causes;
}

std::string look_first_text(const std::vector<LikelyCause>& causes) {
  constexpr size_t most = 3;
  constexpr double least = 0.01;
  std::string text;
  for (size_t k = 0; k < std::min(most, causes.size()) && causes[k].odds >= least; ++k)
    text += fmt::format("{} {} ({:.0f} %; most like the planted bug '{}')", k == 0 ? "" : ";",
                        causes[k].kind, 100 * causes[k].odds, causes[k].nearest);
  return text.empty() ? "" : "Look first at:" + text + "\n";
}

}  // namespace foldproof
