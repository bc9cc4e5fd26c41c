#include "scripts/program/command_line/suggestions.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <utility>

namespace foldproof {

namespace {

/// Letters to add, leave out or change to make b of a (Levenshtein 1966).
size_t edits_between(const std::string& a, const std::string& b) {
  std::vector<size_t> edits(b.size() + 1);  // from the first letters of a to the first k of b
  std::iota(edits.begin(), edits.end(), 0);
  for (size_t i = 0; i < a.size(); ++i) {
    size_t corner = edits[0]++;
    for (size_t k = 0; k < b.size(); ++k) {
      const size_t changed = corner + (a[i] != b[k]);
      corner = edits[k + 1];
      edits[k + 1] = std::min({changed, corner + 1, edits[k] + 1});
    }
  }
  return edits.back();
}

size_t distance(const std::string& typed, const std::string& name) {
  const std::string rest = name.substr(name.find('.') + 1);  // or all of it
  return std::min(edits_between(typed, name), edits_between(typed, rest));
}

}  // namespace

std::vector<std::string> nearest_names(const std::string& typed,
                                       const std::vector<std::string>& known) {
  std::vector<std::pair<size_t, std::string>> near;
  for (const std::string& name : known)
    if (const size_t edits = distance(typed, name); edits <= (typed.size() + 2) / 3)
      near.emplace_back(edits, name);
  std::ranges::sort(near);
  const auto [first, last] = std::ranges::unique(near);
  near.erase(first, last);
  std::vector<std::string> names;
  for (size_t k = 0; k < std::min<size_t>(near.size(), 3); ++k)
    if (near[k].first <= near[0].first + 1) names.push_back(near[k].second);
  return names;
}

std::string did_you_mean(const std::vector<std::string>& names) {
  if (names.empty()) return "";
  const std::vector<std::string> first(names.begin(), names.end() - 1);
  return fmt::format("; did you mean {}{}{}?", fmt::join(first, ", "), first.empty() ? "" : " or ",
                     names.back());
}

}  // namespace foldproof
