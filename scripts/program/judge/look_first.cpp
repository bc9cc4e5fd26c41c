#include "scripts/program/judge/look_first.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

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

double log_likelihood(const std::vector<const PlantedBug*>& bugs,
                      const std::vector<const Record*>& decided) {
  const double count = double(bugs.size());
  double sum = std::log(count);
  for (const Record* record : decided) {
    const auto has = [&](const PlantedBug* bug) { return fails(*bug, record->name); };
    const double share = (double(std::ranges::count_if(bugs, has)) + 0.5) / (count + 1);
    sum += std::log(does_not_hold(*record) ? share : 1 - share);
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
  const auto some_bug_fails = [&](const Record& record) {
    return std::ranges::any_of(bugs,
                               [&](const PlantedBug& bug) { return fails(bug, record.name); });
  };
  std::vector<const Record*> decided;  // laws that no planted bug fails tell nothing
  for (const Record& record : records)
    if (is_decided(record) && some_bug_fails(record)) decided.push_back(&record);
  if (std::ranges::none_of(decided, [](const Record* r) { return does_not_hold(*r); })) return {};
  std::map<std::string, std::vector<const PlantedBug*>> kinds;
  for (const PlantedBug& bug : bugs)
    if (!bug.fails.empty()) kinds[bug.kind].push_back(&bug);  // others have no pattern
  std::vector<LikelyCause> causes;
  for (const auto& [kind, of_kind] : kinds) {
    const auto alike = [&](const PlantedBug* bug) { return likeness(*bug, decided); };
    causes.push_back({kind, (*std::ranges::max_element(of_kind, {}, alike))->name,
                      log_likelihood(of_kind, decided)});
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
